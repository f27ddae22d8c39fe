"""The bits of every library scenario, and of fifty benches put together at random.

``digests.json`` keeps the scenarios of the benches and all digests, and a test compares the results of the code with
them: a change that is not meant to change a bit changes none. When physics changes on purpose, renew the digests with
``make digests``, look at which ones the diff names, and say in CHANGELOG.md why each of them changed. ``make digests
ARGS=--draw`` also draws other benches.

Runs do not depend on the machine: a test computes them again with `OLDER` libraries. Studies, whose figures numpy and
scipy compute, do: see `tests.library_pass.SAME_EVERYWHERE`.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)
from core import registry
from core.board.instances import faults_of
from core.device.catalogue import devices
from core.errors import InputError
from scenarios.library import library
from scenarios.run import run
from scenarios.schema import Scenario
from tests.library_pass import ROOT, SAME_EVERYWHERE

FILE = Path(__file__).with_suffix(".json")

OLDER = {
    "OPENBLAS_CORETYPE": "NEHALEM",
    "NPY_DISABLE_CPU_FEATURES": SAME_EVERYWHERE["NPY_DISABLE_CPU_FEATURES"] + " AVX2 FMA3",
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F,-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-FMA4",
}
"""Told this, the libraries behave as on a processor of 2008, without fused products."""

BENCHES = 50
TICKS = 600
SEED = 2008
CHEAP = [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "b+30", "damping": 1.3}]


class Draw:
    """Choices of one bench."""

    def __init__(self, number: int, attempt: int, seed: int, ticks: int) -> None:
        self._rng, self._ticks = np.random.default_rng([seed, number, attempt]), ticks

    def one(self, *choices: Any) -> Any:
        return choices[int(self._rng.integers(len(choices)))]

    def some(self, choices: list[Any], most: int) -> list[Any]:
        chosen = self._rng.permutation(len(choices))[: int(self._rng.integers(most + 1))]
        return [choices[int(i)] for i in chosen]

    def between(self, low: float, high: float) -> float:
        return round(float(self._rng.uniform(low, high)), 4)

    def sample(self) -> int:
        return int(self._rng.integers(1, self._ticks))


def bench(number: int, attempt: int, seed: int, ticks: int) -> dict[str, Any]:
    """Return the scenario of one bench; not all that is drawn fits together."""
    draw = Draw(number, attempt, seed, ticks)
    device = draw.one(*(entry for entry in devices() if entry.usual_plant == "linear"))
    natural_hz = device.oscillator().natural_frequency * 1e3 / (2 * np.pi)
    controllers = sorted(set(registry.blocks("control")) - {"gain_adaptation"})
    faults = faults_of(())
    reference = draw.one("sine", "sine", "multi_sine", "square", "prbs", "chirp", "step", "constant")
    document: dict[str, Any] = {
        "schema": 1,
        "id": f"bench-{number}",
        "sample_rate_khz": draw.one(50, 100, 200),
        "samples": ticks,
        "seed": int(draw.sample()),
        "device": {"id": device.id},
        "plant": {"model": draw.one("linear", "linear", "nonlinear", "slaved_lateral", "planar")},
        "reference": {"kind": reference},
        "controller": {"kind": draw.one(*controllers)},
        "sensor": {"kind": draw.one("ideal", "ideal", "capacitive", "quadrature", "quadrature_kalman", "dual_beam")},
    }
    if reference == "sine":
        document["reference"] |= {
            "amplitude_v": draw.between(1, 12),
            "frequency_hz": natural_hz * draw.between(0.05, 0.9),
        }
    if document["plant"]["model"] == "linear":
        document["plant"] |= {"drive": "held", "drive_noise_v": draw.one(0.0, 0.01)}
        if draw.one(True, False, False):  # for open loop only
            document["plant"]["drive"], document["controller"], controllers = "analogue", {"kind": "open_loop"}, []
    if document["sensor"]["kind"] == "ideal":
        document["sensor"]["noise_um"] = draw.one(0.0, 0.01, 0.05)
    diagnosers = [name for name, block in registry.blocks("diagnose").items() if not block.axes]
    for kind in draw.some(sorted(diagnosers), 3):
        chosen = {"kind": kind, "every": draw.one(1, 1, 2, 5)}
        if "hypotheses" in registry.block("diagnose", kind).Params.model_fields:
            chosen["hypotheses"] = CHEAP
        document.setdefault("diagnosers", {})[kind] = chosen
    for kind in draw.some(sorted(registry.blocks("identify")), 2):
        document.setdefault("identifiers", {})[kind] = {"kind": kind}
    events: list[dict[str, Any]] = []
    for name in draw.some(sorted(faults), 4):
        severity = float(getattr(faults[name], "suggested", 0.1)) * draw.between(0.3, 1.0)
        profile = draw.one({"kind": "step"}, {"kind": "ramp", "duration_ms": 1.0})
        events.append({"at_sample": draw.sample(), "fault": name, "severity": severity, "profile": profile})
    for name in draw.some(controllers, 2):
        events.append({"at_sample": draw.sample(), "switch": name})
    if draw.one(True, False):
        events.append({"at_sample": ticks - 5, "heal": "all"})
    document["events"] = sorted(events, key=lambda event: event["at_sample"])
    if draw.one(True, False, False):
        twin = {"controller": {"kind": draw.one(*controllers)}} if controllers else {"plant": {"model": "nonlinear"}}
        document["twins"] = {"other": twin}
    return document


def draw_bench(number: int, seed: int = SEED, ticks: int = TICKS) -> dict[str, Any]:
    """Return the first bench drawn for a number that fits together."""
    for attempt in range(1000):
        document = bench(number, attempt, seed, ticks)
        try:
            run(Scenario.load(document))
        except InputError:
            continue
        return document
    raise AssertionError(f"no draw of bench {number} fits together")


def kept() -> dict[str, Any]:
    """Return the content of the file: ``library`` (digest by id) and ``benches`` (scenario and digest of each)."""
    found: dict[str, Any] = json.loads(FILE.read_text())
    return found


def computed(benches: list[dict[str, Any]], *, studies: bool) -> dict[str, Any]:
    """Return the expected content of the file, computed anew, with or without the studies."""
    chosen = [scenario for scenario in library() if studies or scenario.study is None]
    return {
        "library": {scenario.id: run(scenario).digest for scenario in chosen},
        "benches": [{"scenario": one, "digest": run(Scenario.load(one)).digest} for one in benches],
    }


def apart(*arguments: str, machine: dict[str, str] = SAME_EVERYWHERE) -> str:
    """Run this file in a process whose libraries assume a fixed machine; return its output."""
    command = [sys.executable, "-W", "ignore", "-m", "tests.scenarios.digests", *arguments]
    told = subprocess.run(command, cwd=ROOT, env=os.environ | machine, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    return told.stdout


def main() -> None:
    """Print the expected content of the file, ``--runs`` without studies; ``--renew`` writes it, ``--draw`` other
    benches."""
    draw, renew = "--draw" in sys.argv, "--renew" in sys.argv
    if renew:
        FILE.write_text(apart(*(["--draw"] if draw else [])))
        return
    benches = [draw_bench(n) for n in range(BENCHES)] if draw else [one["scenario"] for one in kept()["benches"]]
    print(json.dumps(computed(benches, studies="--runs" not in sys.argv), indent=1))


if __name__ == "__main__":
    main()
