"""The benchmark as files: its cases for tools of any kind, and the answers of such tools, scored.

All files of a list are alike in length, columns and description, so a file of the hidden list has the measured samples
and no other trace of its fault.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from core.block import FloatArray
from core.errors import InputError, one_line, short
from scenarios.arrow import pa, pq
from scenarios.benchmark.answer import CaseProbabilities
from scenarios.benchmark.figures import classed, surprise
from scenarios.benchmark.measure import FALSE_ALARM_SAMPLES, TrackJudge
from scenarios.benchmark.results import BenchmarkResults, Row
from scenarios.benchmark.seeds import BENCHMARK, SeedList
from scenarios.benchmark.track import ONSET, WARM, WITHIN, BenchmarkTrack, Case, tracks
from scenarios.key import code_version
from scenarios.reading import read_bytes
from scenarios.records.columns import Columns
from scenarios.records.reading import MOST_BYTES, READERS
from scenarios.run import run

HIDDEN = "hidden"
SAMPLES = ONSET[1] + WITHIN
"""Samples of a case in a file: enough for the latest fault, and the same for every case."""
OUTSIDE = "computed outside"
"""Mark of rows whose probabilities came from files."""
Told = Callable[[str, int, int], None]


def numbered(track: str, seeds: SeedList) -> list[tuple[str, Case]]:
    """Return all runs of a track with the names of their files: healthy runs for the threshold, then the cases."""
    known = tracks()[track]
    healthy = [(f"healthy-{i:03}", known.healthy(seed)) for i, seed in enumerate(seeds.calibration(track), 1)]
    return healthy + [(f"case-{i:03}", known.case(seed)) for i, seed in enumerate(seeds.cases[track], 1)]


def export_cases(folder: Path, chosen: Sequence[str], seeds: SeedList, told: Told) -> int:
    """Write each run of some tracks as a Parquet file; return how many.

    Raises
    ------
    InputError
        When the folder is not empty, or cannot be written.
    """
    try:
        if folder.exists() and any(folder.iterdir()):
            raise InputError(f"{folder} is not empty", "--export", "name a new folder")
        count = 0
        for track in chosen:
            (folder / track).mkdir(parents=True, exist_ok=True)
            runs = numbered(track, seeds)
            for number, (name, case) in enumerate(runs, 1):
                table = _table(tracks()[track], case, seeds.name == HIDDEN)
                pq.write_table(table, folder / track / f"{name}.parquet", compression="zstd")
                told(track, number, len(runs))
            count += len(runs)
    except OSError as error:
        raise InputError(f"cannot write to {folder}: {error.strerror}", "--export") from None
    return count


def _table(track: BenchmarkTrack, case: Case, is_hidden: bool) -> pa.Table:
    """Return a run as a table; ``onset`` and ``truth`` are not in a hidden case."""
    is_case = case.onset < case.document["samples"]
    samples = SAMPLES if is_case else case.document["samples"]
    scenario = Case(case.seed, {**case.document, "samples": samples}, case.onset, case.truth).scenario({}, {})
    result = run(scenario)
    if result.trip is not None:
        raise InputError(f"stopped in case {case.seed} at sample {result.trip.tick}: {result.trip.reason}")
    dt_ms = result.board.dt_ms
    columns: dict[str, Any] = {"time": np.arange(samples) * dt_ms}
    columns |= {"drive": result.signal("drive.voltage"), "displacement": result.signal("sensor.displacement")}
    units = {"time": "ms", "drive": "V", "displacement": "um"}
    if is_case and not is_hidden:
        columns["onset"] = np.full(samples, case.onset)
        columns["truth"] = np.where(np.arange(samples) < case.onset, 0, case.truth)
    fields = [
        pa.field(name, pa.from_numpy_dtype(values.dtype), metadata={"unit": units[name]} if name in units else None)
        for name, values in columns.items()
    ]
    about = json.dumps(_about(track, scenario.spec, dt_ms))
    return pa.table([*columns.values()], schema=pa.schema(fields, metadata={"combbench": about}))


def _about(track: BenchmarkTrack, spec: Any, dt_ms: float) -> dict[str, Any]:
    """Return the knowledge that every diagnoser is given: the device as drawn, hypotheses and classes."""
    nominal = spec.nominal
    return {
        "benchmark": BENCHMARK,
        "dt_ms": dt_ms,
        "device": {
            "mass_mg": nominal.mass,
            "damping_un_ms_um": nominal.damping,
            "stiffness_un_um": nominal.stiffness,
            "force_un_v": nominal.force,
        },
        "noise_um": spec.context().sensor_noise_um,
        "hypotheses": [item.model_dump(exclude_defaults=True) for item in track.hypotheses],
        "classes": track.classes,
        "warm_samples": WARM,
    }


def score_answers(folder: Path, chosen: Sequence[str], seeds: SeedList, told: Told) -> BenchmarkResults:
    """Score the answers in a folder: for each run a file of its name, with the probability of each class or hypothesis.

    Raises
    ------
    InputError
        Naming the file that is missing or does not fit.
    """
    rows = [_row(folder / track, track, seeds, told) for track in chosen if (folder / track).is_dir()]
    if not rows:
        raise InputError(f"{folder} has no folder of a track: {', '.join(chosen)}", "--answers")
    return BenchmarkResults(
        benchmark=BENCHMARK,
        version=code_version(),
        seeds=seeds.name,
        false_alarm_samples=FALSE_ALARM_SAMPLES,
        sources={},
        rows=rows,
        left_out=[],
    )


def _row(folder: Path, track: str, seeds: SeedList, told: Told) -> Row:
    unit, calm, judge = f"{folder.parent.name} ({OUTSIDE})", list[FloatArray](), None
    runs = numbered(track, seeds)
    for number, (name, case) in enumerate(runs, 1):
        answer = read_answer(folder, name, tracks()[track], case)
        if case.onset >= case.document["samples"]:
            calm.append(answer.evidence[WARM:])
        else:
            judge = judge or TrackJudge(unit, track, calm)
            judge.take(case, answer)
        told(track, number, len(runs))
    assert judge is not None
    return judge.row()


def read_answer(folder: Path, name: str, track: BenchmarkTrack, case: Case) -> CaseProbabilities:
    """Return the answer to a run, until the sample that ends its case."""
    found = sorted(file for file in folder.glob(f"{name}.*") if file.suffix in READERS)
    if len(found) != 1:
        text = f"{folder.name} has no answer {name}" if not found else f"{folder.name} has {len(found)} answers {name}"
        raise InputError(text, "--answers", f"one of {', '.join(READERS)}")
    try:
        columns = READERS[found[0].suffix](read_bytes(found[0], "--answers", MOST_BYTES))
        return _answer(columns, track, case)
    except InputError as error:
        raise InputError(f"{folder.name}/{found[0].name}: {error.message}", "--answers") from None


def _answer(columns: Columns, track: BenchmarkTrack, case: Case) -> CaseProbabilities:
    hypotheses, classes = [item.name for item in track.hypotheses], [*track.classes]
    groups = [*track.classes.values()]
    if all(name in columns.numbers for name in hypotheses):
        names = hypotheses
        places = [next(i for i, group in enumerate(groups) if name in group) for name in names]
    else:
        names, places = classes, [*range(len(classes))]
    for name in names:
        if name not in columns.numbers:
            raise InputError(f"has no probability of {short(name)}; needed: {one_line(', '.join(names))}")
    expected = SAMPLES if case.onset < case.document["samples"] else case.document["samples"]
    for name in names:
        if len(columns.numbers[name]) != expected:
            text = f"{one_line(short(name))} has {len(columns.numbers[name])} rows; the run has {expected} samples"
            raise InputError(text)
    said = np.ascontiguousarray([columns.numbers[name][: case.document["samples"]] for name in names])
    wrong = np.argwhere(~(said >= 0.0) | (said > 1.0 + 1e-9))
    if len(wrong):
        column, row = wrong[0].tolist()
        value = said[column, row]
        raise InputError(f"sample {row}, {one_line(short(names[column]))}: {value:g} is no probability")
    p = classed(said, np.array(places, dtype=np.int64), len(groups))
    return CaseProbabilities(surprise(p[0]), p, hashlib.sha256(said.tobytes()).hexdigest())
