"""Rates of campaigns: by the command, by processes, and by a loop of single runs."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from core.errors import InputError
from scenarios.campaign.campaign import Campaign, Found
from scenarios.campaign.sweep import Sweep
from scenarios.library import get
from scenarios.run import run
from scenarios.speed.timing import cpu_ns

SCENARIO = "ch5-seven-step"
FEW, MANY = 500, 3000
"""Runs of a short campaign and of a long campaign: the rate is the rate of the difference."""
REPEATS = 5
SPREAD = """
[latin_hypercube]
points = {runs}
seed = 1

[latin_hypercube.ranges]
"device.mass_kg" = {{ min = 2.0e-10, max = 2.4e-10 }}
"device.stiffness_n_m" = {{ min = 0.051, max = 0.056 }}
"device.damping_ns_m" = {{ min = 6.5e-7, max = 7.5e-7 }}
"""
"""Devices of a process, each once."""
SEEDS = "[seeds]\ncount = {runs}\n"
"""The same device, with noise of its own in each run."""


class _Kept:
    """A run table in memory that records the moment of every batch."""

    def __init__(self) -> None:
        self.batches: list[tuple[float, int]] = []

    def have(self, keys: Sequence[str]) -> set[str]:  # noqa: ARG002
        """Return no keys: all runs are to be computed."""
        return set()

    def outcomes(self, keys: Sequence[str]) -> Found:  # noqa: ARG002
        """Return nothing: no outcome is kept."""
        return []

    def put(self, found: Found) -> None:
        """Record the moment and the size of a batch."""
        self.batches.append((time.perf_counter(), len(found)))


def rate(workers: int, runs: int, first_seed: int) -> float:
    """Return the runs per second of the seven-step scenario once the processes are up.

    Parameters
    ----------
    workers : int
        Processes.
    runs, first_seed : int
        Number of seeds, and the first of them.
    """
    document = {"schema": 1, "scenario": SCENARIO, "seeds": {"first": first_seed, "count": runs}}
    table = _Kept()
    Campaign(Sweep(document), table, workers=workers).run()
    # The clock starts after the first quarter, when all processes are up and batches have their size.
    done = 0
    for moment, count in table.batches:
        done += count
        if 4 * done >= runs:
            return (runs - done) / (table.batches[-1][0] - moment)
    raise AssertionError("a campaign ends with all its runs")


def shares(runs: int, repeats: int = REPEATS) -> list[float]:
    """Return rate(2) / (2 rate(1)) of alternating measurements."""
    pairs = [(rate(1, runs // 2, 1), rate(2, runs, 1)) for _ in range(repeats)]
    return [double / (2.0 * single) for single, double in pairs]


def sweep_s(axes: str) -> float:
    """Return how long ``combbench sweep`` takes with the seven steps on two processes, from start to report, s."""
    command = Path(sys.executable).with_name("combbench")
    if not command.exists():
        raise InputError(f"is not beside {sys.executable}: install the project, then measure", "combbench")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "campaign.toml"
        file.write_text(f'schema = 1\nid = "speed"\nscenario = "{SCENARIO}"\n{axes}')
        begin = time.perf_counter()
        asked: list[str | Path] = [command, "sweep", file, "--workers", "2", "--out", Path(folder) / "out"]
        subprocess.run(asked, check=True, capture_output=True)
        return time.perf_counter() - begin


def command_rates(axes: str, repeats: int = REPEATS) -> tuple[list[float], list[float]]:
    """Return the runs per second of the command on two processes, and its seconds for the longer campaign.

    The rate is the rate of the additional runs of a longer campaign, so that it excludes the time of the start.
    """
    rates, whole = [], []
    for _ in range(repeats):
        short, long = (sweep_s(axes.format(runs=runs)) for runs in (FEW, MANY))
        rates.append((MANY - FEW) / (long - short))
        whole.append(long)
    return rates, whole


def single_runs(runs: int = 20, repeats: int = REPEATS) -> list[float]:
    """Return the runs per second of a Python loop of single runs on one processor."""
    scenario = get(SCENARIO)
    run(scenario, 0)

    def work() -> None:
        for seed in range(runs):
            run(scenario, seed)

    return [1e9 / cpu_ns(work, runs) for _ in range(repeats)]
