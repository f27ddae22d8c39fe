"""How well a campaign uses two processors: its rate on two processes over twice the rate on one."""

from __future__ import annotations

import time
from collections.abc import Sequence
from statistics import median

from scenarios.campaign.campaign import Campaign, Found
from scenarios.campaign.sweep import Sweep

REPEATS = 3


class _Kept:
    """A run table in memory, with the moment every batch came."""

    def __init__(self) -> None:
        self.batches: list[tuple[float, int]] = []

    def have(self, keys: Sequence[str]) -> set[str]:  # noqa: ARG002
        """Return nothing: all is to be computed."""
        return set()

    def put(self, found: Found) -> None:
        """Note when a batch came."""
        self.batches.append((time.perf_counter(), len(found)))


def rate(workers: int, runs: int, first_seed: int) -> float:
    """Return the runs per second of the seven-step scenario once the processes are up.

    Parameters
    ----------
    workers : int
        Processes.
    runs, first_seed : int
        How many seeds, and the first of them.
    """
    document = {"schema": 1, "scenario": "ch5-seven-step", "seeds": {"first": first_seed, "count": runs}}
    table = _Kept()
    Campaign(Sweep(document), table, workers=workers).run()
    # The clock starts behind the first quarter, when all processes are up and batches have their size.
    done = 0
    for moment, count in table.batches:
        done += count
        if 4 * done >= runs:
            return (runs - done) / (table.batches[-1][0] - moment)
    raise AssertionError("a campaign ends with all its runs")


def scaling(runs: int, repeats: int = REPEATS) -> tuple[float, float]:
    """Return the median of rate(2) / (2 rate(1)) over alternating measurements, and the best rate of two processes."""
    pairs = [(rate(1, runs // 2, 1), rate(2, runs, 1)) for _ in range(repeats)]
    return median(two / (2.0 * one) for one, two in pairs), max(two for _, two in pairs)
