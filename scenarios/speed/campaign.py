"""Use of two processors by a campaign: its rate on two processes over twice the rate on one."""

from __future__ import annotations

import time
from collections.abc import Sequence
from statistics import median

from scenarios.campaign.campaign import Campaign, Found
from scenarios.campaign.sweep import Sweep

REPEATS = 3


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
    document = {"schema": 1, "scenario": "ch5-seven-step", "seeds": {"first": first_seed, "count": runs}}
    table = _Kept()
    Campaign(Sweep(document), table, workers=workers).run()
    # The clock starts after the first quarter, when all processes are up and batches have their size.
    done = 0
    for moment, count in table.batches:
        done += count
        if 4 * done >= runs:
            return (runs - done) / (table.batches[-1][0] - moment)
    raise AssertionError("a campaign ends with all its runs")


def scaling(runs: int, repeats: int = REPEATS) -> tuple[float, float]:
    """Return the median of rate(2) / (2 rate(1)) over alternating measurements, and the best rate of two processes."""
    pairs = [(rate(1, runs // 2, 1), rate(2, runs, 1)) for _ in range(repeats)]
    return median(double / (2.0 * single) for single, double in pairs), max(double for _, double in pairs)
