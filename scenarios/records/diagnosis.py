"""A record diagnosed: calibrated by a healthy stretch, then looked at by the banks of a bench."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Literal, cast

import numpy as np

from core.block import BoolArray
from core.board.board import Board
from core.board.instances import scored
from core.board.rows import Rows
from core.diagnose.hypothesis import ModelList, names_of
from core.errors import InputError
from core.format import format_percent
from core.measured_record import MeasuredRecord
from core.signals import Signal
from scenarios.measure.blocks import loaded, stretches
from scenarios.records.bench import on_record
from scenarios.records.calibration import Calibration, calibrate
from scenarios.records.shelf import RecordFolder
from scenarios.run import RunResult, run
from scenarios.schema import Scenario

UNEXPLAINED = "unexplained"
SURE = 0.9
"""Probability from which a verdict counts."""
UNSURE = "unsure"
MOST_UNEXPLAINED = 0.2
"""Share of unexplained samples from which a record counts as unexplained."""
Outcome = Literal["no fault", "fault", "unexplained", "refused"]
"""Outcomes of a diagnosis; of several banks the worst counts."""
MOST_WRONG = 0.1
"""Share of the second half of the healthy stretch that a bank may call faulty."""
SHORTEST = 20
"""Samples a verdict must last to be listed by itself."""


@dataclass(frozen=True)
class RecordVerdict:
    """A stretch of samples with one verdict: a hypothesis, `UNEXPLAINED` or `UNSURE`; its mean probability."""

    first: int
    end: int
    verdict: str
    probability: float


@dataclass
class RecordDiagnosis:
    """The calibration, the scenario that plays the record, and the verdicts of each bank; none after a refusal."""

    record: MeasuredRecord
    calibration: Calibration
    bench: Scenario | None = None
    result: RunResult | None = field(default=None, repr=False)
    verdicts: dict[str, list[RecordVerdict]] = field(default_factory=dict)
    shares: dict[str, dict[str, float]] = field(default_factory=dict)
    healthy: dict[str, str] = field(default_factory=dict)
    contradiction: str = ""

    @property
    def refusal(self) -> str:
        """Why there is no verdict; empty where there is."""
        return self.calibration.refusal or self.contradiction

    def faults(self, name: str) -> dict[str, float]:
        """Return the faults that a bank names, each with its share of the record."""
        return _faults(self.shares[name], self.healthy[name])

    @property
    def outcome(self) -> Outcome:
        """The outcome; of several banks the worst counts."""
        if self.refusal:
            return "refused"
        if any(shares.get(UNEXPLAINED, 0.0) >= MOST_UNEXPLAINED for shares in self.shares.values()):
            return "unexplained"
        return "fault" if any(self.faults(name) for name in self.shares) else "no fault"

    @property
    def sentence(self) -> str:
        """The outcome in a sentence."""
        if self.refusal:
            return f"Refused: {self.refusal}."
        if self.outcome == "unexplained":
            name, shares = max(self.shares.items(), key=lambda entry: entry[1].get(UNEXPLAINED, 0.0))
            return f"Unexplained: no hypothesis of {name} fits {format_percent(shares[UNEXPLAINED])} of the record."
        if self.outcome == "fault":
            name = max(self.shares, key=lambda one: sum(self.faults(one).values()))
            said = ", ".join(f"{word} in {format_percent(share)}" for word, share in self.faults(name).items())
            return f"Fault: {name} names {said} of the record."
        name = max(self.shares, key=lambda one: self.shares[one].get(UNSURE, 0.0))
        unsure = self.shares[name].get(UNSURE, 0.0)
        left = f"; {name} is unsure in {format_percent(unsure)}" if unsure else ""
        return f"No fault: no bank names one{left}."


def diagnose(
    record: MeasuredRecord,
    scenario: Scenario,
    first: int = 0,
    end: int | None = None,
    folder: RecordFolder | None = None,
) -> RecordDiagnosis:
    """Return the diagnosis of a record.

    Parameters
    ----------
    record : MeasuredRecord
        Its labels are not read for the verdicts; where it has labels, the figures of the result have the score.
    scenario : Scenario
        The bench whose diagnosers look at it.
    first, end : int
        The healthy stretch; without an end the first quarter of the record.

    Raises
    ------
    InputError
        For a stretch that cannot calibrate.
    """
    end = max(record.samples // 4, 1) if end is None else end
    calibration = calibrate(record, scenario.spec.nominal, first, end)
    if calibration.refusal:
        return RecordDiagnosis(record, calibration)
    document = on_record(scenario, record, calibration=calibration)
    with (folder or RecordFolder()).keeping(record):
        bench = Scenario.load(document)
    banks = {name: section.params for name, section in bench.spec.diagnosers.items() if scored(section.block)}
    gathered = _Unexplained(banks)
    result = run(bench, trace=gathered)
    if result.trip is not None:
        raise InputError(f"the bench stopped at sample {result.trip.tick}: {result.trip.reason}", "record")
    found = RecordDiagnosis(record, calibration, bench, result)
    unexplained = gathered.columns()
    for name, params in banks.items():
        names, nominal = names_of(params), cast(ModelList, params).nominal
        words = _words(result, name, names, unexplained[f"{name}.unexplained"])
        found.verdicts[name] = words
        found.healthy[name] = "" if nominal is None else names[nominal]
        found.shares[name] = _shares(words, 0, record.samples)
        if wrong := _contradiction(found, name):
            return RecordDiagnosis(record, calibration, contradiction=wrong)
    return found


def _contradiction(found: RecordDiagnosis, name: str) -> str:
    """Return in words that a bank, which has settled, finds a fault in the stretch that is known to be healthy."""
    of = found.calibration
    middle, end = of.first + of.samples // 2, of.first + of.samples
    wrong = _faults(_shares(found.verdicts[name], middle, end), found.healthy[name])
    if not found.healthy[name] or sum(wrong.values()) <= MOST_WRONG:
        return ""
    word = next(iter(wrong))
    return (
        f"{name} names {word} in the healthy stretch, where there is none: the noise that it assumes does not fit this "
        "record, or the voltage hardly tells its hypotheses apart"
    )


class _Unexplained:
    """Gathers where no hypothesis of a bank fits; all inner signals of a long record would fill a disk."""

    def __init__(self, banks: Iterable[str]) -> None:
        self._names = [f"{name}.unexplained" for name in banks]
        self._places = np.zeros(0, np.int64)
        self._parts: list[BoolArray] = []

    def begin(self, board: Board, signals: list[Signal]) -> None:  # noqa: ARG002 (the signals that the run keeps)
        """Find the signals among the inner signals of the board."""
        self._places = np.array([board.signals.index(name) - board.signals.outputs for name in self._names], np.int64)

    def add(self, rows: Rows) -> None:
        """Take some rows."""
        self._parts.append(rows.taps[:, self._places] != 0.0)

    def columns(self) -> dict[str, BoolArray]:
        """Return for each bank whether a sample is unexplained."""
        return dict(zip(self._names, np.concatenate(self._parts).T, strict=True))


def _words(result: RunResult, name: str, hypotheses: list[str], unexplained: BoolArray) -> list[RecordVerdict]:
    """Return the verdicts of a bank, stretch by stretch; short ones belong to the stretch before."""
    probability = np.stack([loaded(result.signal(f"{name}.probability.{one}")) for one in hypotheses])
    winner, most = probability.argmax(axis=0), probability.max(axis=0)
    words = [*hypotheses, UNSURE, UNEXPLAINED]
    index = np.where(most >= SURE, winner, len(hypotheses))
    index[unexplained] = len(hypotheses) + 1
    found: list[RecordVerdict] = []
    for first, end in pairwise([*stretches(index.astype(np.float64)), len(index)]):
        word = words[index[first]]
        mean = float(most[first:end].mean())
        if found and (end - first < SHORTEST or found[-1].verdict == word):
            last = found.pop()
            long = last.end - last.first
            mean = (last.probability * long + mean * (end - first)) / (long + end - first)
            found.append(RecordVerdict(last.first, end, last.verdict, mean))
        else:
            found.append(RecordVerdict(first, end, word, mean))
    return found


def _shares(verdicts: list[RecordVerdict], first: int, end: int) -> dict[str, float]:
    """Return the share of the samples of a stretch that each verdict has, the largest first."""
    counted: dict[str, float] = {}
    for one in verdicts:
        if (count := min(one.end, end) - max(one.first, first)) > 0:
            counted[one.verdict] = counted.get(one.verdict, 0.0) + count / (end - first)
    return dict(sorted(counted.items(), key=lambda entry: -entry[1]))


def _faults(shares: dict[str, float], healthy: str) -> dict[str, float]:
    """Return the shares of the verdicts that are faults."""
    return {word: share for word, share in shares.items() if word not in {UNEXPLAINED, UNSURE, healthy}}


def as_document(found: RecordDiagnosis) -> dict[str, Any]:
    """Return a diagnosis as JSON can carry it."""
    calibration = found.calibration
    estimates = ("mass", "damping", "stiffness", "offset_um", "delay_samples")
    return {
        "samples": found.record.samples,
        "rate_khz": found.record.rate_khz,
        "calibration": {
            **{name: vars(getattr(calibration, name)) for name in estimates},
            "noise_um": calibration.noise_um,
            "quantum_um": calibration.quantum_um,
            "first": calibration.first,
            "samples": calibration.samples,
            "checks": [vars(one) for one in calibration.checks],
        },
        "outcome": found.outcome,
        "sentence": found.sentence,
        "refusal": found.refusal,
        "verdicts": {name: [vars(one) for one in verdicts] for name, verdicts in found.verdicts.items()},
        "shares": found.shares,
        "figures": found.result.metrics if found.result is not None and found.record.label is not None else {},
    }
