"""Foreign devices by the hundred, calibrated and diagnosed: ``python -m tests.scenarios.records.study SEED``.

Prints the shares of right verdicts, of refusals and of intervals that cover the truth; for devices outside the model
the numbers that are refused or unexplained, and that get a confident fault which is not there.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from core.measured_record import MeasuredRecord
from core.units import MG_PER_KG
from scenarios.library import get
from scenarios.record_folders import FOLDER
from scenarios.records import shelf
from scenarios.records.diagnosis import MOST_UNEXPLAINED, UNEXPLAINED, RecordVerdict, diagnose
from scenarios.records.shelf import RecordFolder
from scenarios.schema import Scenario
from tests.scenarios.records.foreign import (
    CHAPTER_3,
    EXCITATIONS,
    HEALTHY,
    NAMES,
    OTHERS,
    Foreign,
    NominalDevice,
    draw,
    other_nominal,
)

CLASSES = ("second mode", "stiction", "saturation", "higher order", "drifting delay")
INSIDE = ""


@dataclass(frozen=True)
class Judged:
    """What a bench said of a foreign device.

    Parameters
    ----------
    seed, outside, excitation
        The device.
    refusal : str
        Why it was refused; empty: it was not.
    right : float
        Share of the samples after the healthy stretch whose most probable hypothesis is the true one; 0 if refused.
    unexplained : float
        Share of all samples that no hypothesis explains.
    false_fault : float
        Share of all samples with a confident fault that is not the true one.
    covered : dict
        Whether the 95 % interval of each fitted number has the truth.
    misses : dict
        Errors of the fitted numbers in standard errors.
    """

    seed: int
    outside: str
    excitation: str
    refusal: str
    right: float = 0.0
    unexplained: float = 0.0
    false_fault: float = 0.0
    covered: dict[str, bool] = field(default_factory=dict)
    misses: dict[str, float] = field(default_factory=dict)


def bench_of(nominal: NominalDevice) -> Scenario:
    """Return a bench with the bank of the first look for a nominal device."""
    usual = get("first-look")
    if nominal == CHAPTER_3:
        return usual
    device = {
        "id": "ch3",
        "bias_v": 6.0,
        "mass_kg": nominal.m / MG_PER_KG,
        "damping_ns_m": nominal.b / 1e3,
        "stiffness_n_m": nominal.k,
        "force_n_per_v": abs(nominal.f) / MG_PER_KG,
    }
    reference = {"kind": "sine", "amplitude_v": 4.0, "frequency_hz": 800.0 * nominal.khz}
    return Scenario.load(
        {**usual.document, "device": device, "reference": reference, "sample_rate_khz": 1.0 / nominal.dt}
    )


def judged(seed: int, outside: str, is_other: bool, folder: RecordFolder | None = None) -> Judged:
    """Draw a device, calibrate and diagnose its record, and compare with the truth."""
    nominal = other_nominal(seed) if is_other else CHAPTER_3
    one = draw(seed, outside, nominal=nominal, excitations=OTHERS if is_other else EXCITATIONS)
    record = MeasuredRecord(1.0 / nominal.dt, one.drive.copy(), one.displacement.copy())
    found = diagnose(record, bench_of(nominal), 0, HEALTHY, folder)
    numbers = {name: (getattr(found.calibration, name), truth) for name, truth in one.ratios.items()}
    covered = {name: bool(abs(n.value - truth) <= 1.96 * n.error) for name, (n, truth) in numbers.items()}
    misses = {name: float((n.value - truth) / n.error) for name, (n, truth) in numbers.items()}
    kept = Judged(seed, outside, str(one.drawn["excitation"]), found.refusal, covered=covered, misses=misses)
    if found.result is None:
        return kept
    winner = np.stack([found.result.signal(f"kalman.probability.{name}") for name in NAMES]).argmax(axis=0)
    return Judged(
        **{
            **asdict(kept),
            "right": float((winner == one.truth)[HEALTHY:].mean()),
            "unexplained": found.shares["kalman"].get(UNEXPLAINED, 0.0),
            "false_fault": _false_fault(one, found.verdicts["kalman"]),
        }
    )


def _false_fault(one: Foreign, verdicts: Iterable[RecordVerdict]) -> float:
    truth = np.array(NAMES)[one.truth]
    wrong = sum(int(np.sum(truth[v.first : v.end] != v.verdict)) for v in verdicts if v.verdict in NAMES[1:])
    return wrong / len(truth)


def _job(arguments: tuple[int, str, bool]) -> Judged:
    with tempfile.TemporaryDirectory() as folder:
        os.environ[FOLDER] = folder
        return judged(*arguments, shelf.prepare())


def inside_lines(rows: list[Judged]) -> list[str]:
    """Return the figures of devices that the model fits."""
    kept = [one for one in rows if not one.refusal]
    lines = [
        f"right verdicts {np.mean([one.right for one in rows]):.4f} of the samples"
        f" ({np.mean([one.right for one in kept]):.4f} where not refused)",
        f"devices with at least .95 right {np.mean([one.right >= 0.95 for one in rows]):.4f}",
        f"refused {len(rows) - len(kept)} of {len(rows)}",
    ]
    for name in rows[0].covered:
        lines.append(f"interval of {name} covers {np.mean([one.covered[name] for one in kept]):.4f}")
    every = [is_in for one in kept for is_in in one.covered.values()]
    return [*lines, f"intervals cover {np.mean(every):.4f}"]


def outside_lines(rows: list[Judged]) -> list[str]:
    """Return the figures of devices outside the model, class by class."""
    lines = []
    for name in dict.fromkeys(one.outside for one in rows):
        of = [one for one in rows if one.outside == name]
        refused = sum(bool(one.refusal) for one in of)
        said = refused + sum(not one.refusal and one.unexplained >= MOST_UNEXPLAINED for one in of)
        wrong = sum(one.false_fault > 0.0 for one in of)
        lines.append(f"{name}: refused {refused}, or unexplained {said} of {len(of)}; with a false fault {wrong}")
    return lines


def main() -> None:
    """Judge many devices, and print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("seed", type=int, help="of the first device; the others follow")
    parser.add_argument("--devices", type=int, default=200)
    parser.add_argument("--outside", type=int, default=24, help="devices of each class outside the model")
    parser.add_argument("--other", action="store_true", help="another nominal device, rate and excitation each time")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--out", type=Path, help="a line of JSON for each device")
    asked = parser.parse_args()
    jobs = [(asked.seed + i, INSIDE, asked.other) for i in range(asked.devices)]
    jobs += [(asked.seed + i, name, asked.other) for name in CLASSES for i in range(asked.outside)]
    rows = []
    with ProcessPoolExecutor(asked.processes, get_context("spawn")) as pool:
        for row in pool.map(_job, jobs):
            rows.append(row)
            if asked.out:
                with asked.out.open("a") as file:
                    file.write(json.dumps(asdict(row)) + "\n")
    inside = [one for one in rows if one.outside == INSIDE]
    print("\n".join([*(inside_lines(inside) if inside else []), *outside_lines([o for o in rows if o.outside])]))


if __name__ == "__main__":
    main()
