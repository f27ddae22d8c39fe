"""Measures diagnosers on the tracks: thresholds by healthy runs first, then the cases."""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from core.block import Block, FloatArray
from core.board.document import Document
from core.board.library import library_of
from scenarios.benchmark.answer import CaseProbabilities, answers, section, unscored
from scenarios.benchmark.figures import (
    BINS,
    alarms,
    estimate,
    false_switches,
    found_within,
    isolation,
    named,
    reliability,
    rises,
    scores,
)
from scenarios.benchmark.results import WITHIN_SAMPLES, BenchmarkResults, CaseDigest, LeftOut, Row, bins, hash_of
from scenarios.benchmark.seeds import BENCHMARK, SeedList
from scenarios.benchmark.track import WARM, BenchmarkTrack, Case, tracks
from scenarios.key import code_version
from scenarios.studies.detectors import threshold_at

FALSE_ALARM_SAMPLES = 20_000
"""Samples between false alarms, on average, that every threshold is set for."""
FIGURES = (
    "log_score",
    "brier",
    "delay_samples",
    "missed",
    "detection",
    "false_alarm",
    "isolation",
    "truth_probability",
    "false_switches",
)
"""Figures that are means over cases."""
Told = Callable[[str, int, int], None]
"""Called with the track, the runs done and all runs."""


def measure(
    units: Sequence[str],
    chosen: Sequence[str],
    seeds: SeedList,
    told: Told = lambda _track, _done, _all: None,
    own: Document | None = None,
) -> BenchmarkResults:
    """Measure diagnosers on tracks.

    Parameters
    ----------
    units, chosen : sequence of str
        Names of diagnosers and of tracks.
    seeds : SeedList
        Which cases.
    told : callable
        Called after each run.
    own : dict, optional
        User units, as a scenario carries them.

    Raises
    ------
    InputError
        For an unknown name.
    """
    own = own or {}
    library = library_of({"units": own})
    blocks = {unit: library.block("diagnose", unit, "UNIT") for unit in units}
    reasons = {unit: unscored(block) for unit, block in blocks.items()}
    scored = {unit: block for unit, block in blocks.items() if not reasons[unit]}
    rows = []
    for name in chosen if scored else ():
        track = tracks()[name]
        sections = {unit: section(block, track) for unit, block in scored.items()}
        rows += _rows(name, track, sections, own, seeds, told)
    return BenchmarkResults(
        benchmark=BENCHMARK,
        version=code_version(),
        seeds=seeds.name,
        false_alarm_samples=FALSE_ALARM_SAMPLES,
        sources={unit: _source(block) for unit, block in blocks.items()},
        rows=rows,
        own={unit: own[unit]["source"] for unit in units if unit in own},
        left_out=[LeftOut(unit=u, track=name, reason=why) for u, why in reasons.items() if why for name in chosen],
    )


def _source(block: type[Block]) -> str:
    """Return a hash of the file of a diagnoser, or of the text of a user unit."""
    if block.text:
        return hashlib.sha256(block.text.encode()).hexdigest()
    return hashlib.sha256(inspect.getsource(inspect.getmodule(block) or block).encode()).hexdigest()


def _rows(
    name: str, track: BenchmarkTrack, sections: Mapping[str, Document], own: Document, seeds: SeedList, told: Told
) -> list[Row]:
    """Measure diagnosers on one track, all of them side by side."""
    healthy, cases = seeds.calibration(name), seeds.cases[name]
    calm: dict[str, list[FloatArray]] = {unit: [] for unit in sections}
    for number, seed in enumerate(healthy, 1):
        for unit, answer in answers(track, track.healthy(seed), sections, own).items():
            calm[unit].append(answer.evidence[WARM:])
        told(name, number, len(healthy) + len(cases))
    judges = {unit: TrackJudge(unit, name, records) for unit, records in calm.items()}
    for number, seed in enumerate(cases, len(healthy) + 1):
        case = track.case(seed)
        for unit, answer in answers(track, case, sections, own).items():
            judges[unit].take(case, answer)
        told(name, number, len(healthy) + len(cases))
    return [judge.row() for judge in judges.values()]


class TrackJudge:
    """Sets the threshold of one diagnoser on one track, and adds up its cases.

    Parameters
    ----------
    unit, track : str
        Their names.
    calm : list of ndarray
        Its evidence in each healthy run.
    """

    def __init__(self, unit: str, track: str, calm: list[FloatArray]) -> None:
        self._unit, self._track = unit, track
        self._threshold = threshold_at(calm, 1.0 / FALSE_ALARM_SAMPLES)
        self._calm_samples = sum(len(record) for record in calm)
        self._calm_alarms = sum(rises(record > self._threshold) for record in calm)
        self._figures: dict[str, list[float | None]] = {name: [] for name in FIGURES}
        self._reliability = np.zeros((3, BINS))
        self._false_alarms = self._healthy_samples = 0
        self._cases: list[CaseDigest] = []

    def take(self, case: Case, answer: CaseProbabilities) -> None:
        """Add the answer in a case."""
        alarm = alarms(answer.evidence, self._threshold, WARM, case.onset)
        self._false_alarms += alarm.episodes
        self._healthy_samples += case.onset - WARM
        found: dict[str, float | None] = {
            "delay_samples": alarm.delay,
            "missed": alarm.missed,
            "detection": alarm.detection,
            "false_alarm": alarm.false_alarm,
        }
        if answer.classes is not None:
            p, truth = np.ascontiguousarray(answer.classes[:, WARM:]), np.zeros(len(answer.evidence), dtype=np.int64)
            truth[case.onset :] = case.truth
            truth = truth[WARM:]
            found["log_score"], found["brier"] = scores(p, truth)
            found["false_switches"] = float(false_switches(named(p, 0), truth))
            self._reliability += reliability(p, truth)
            detected = isolation(answer.classes, answer.evidence > self._threshold, case.truth, case.onset)
            found["isolation"], found["truth_probability"] = detected or (None, None)
        for name in FIGURES:
            self._figures[name].append(found.get(name))
        self._cases.append(CaseDigest(seed=case.seed, scenario=case.hash, digest=answer.digest))

    def row(self) -> Row:
        """Return the row of all cases so far."""
        return Row(
            unit=self._unit,
            track=self._track,
            threshold=self._threshold,
            calibration_alarms=self._calm_alarms,
            calibration_samples=self._calm_samples,
            false_alarms=self._false_alarms,
            healthy_samples=self._healthy_samples,
            **{name: estimate(values) for name, values in self._figures.items()},
            found_within=found_within(self._figures["delay_samples"], WITHIN_SAMPLES),
            reliability=bins(self._reliability.tolist()) if self._reliability[0].any() else [],
            scenario=hash_of([case.scenario for case in self._cases]),
            digest=hash_of([case.digest for case in self._cases]),
            cases=self._cases,
        )
