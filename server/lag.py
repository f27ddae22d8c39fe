"""Lateness of the event loop's timers and of the engine's rounds."""

from __future__ import annotations

import asyncio
import time

import numpy as np
from prometheus_client import Histogram

PERIOD_S = 0.02
KEPT = 4096
"""Measurements kept: about a minute."""

FRESH_S = 1.0


class Lateness:
    """The last measurements of one kind; one thread adds them, another reads them.

    Parameters
    ----------
    histogram : Histogram
        Where each measurement is observed as well.
    """

    def __init__(self, histogram: Histogram) -> None:
        self._histogram = histogram
        self._ring = np.zeros(KEPT)
        self._count = 0
        self._p99_ms, self._asked_at = 0.0, -1e9

    def add(self, seconds: float) -> None:
        """Add a measurement."""
        self._ring[self._count % KEPT] = seconds
        self._count += 1
        self._histogram.observe(seconds)

    def p99_ms(self) -> float:
        """Return the 99th percentile of the last minute; at most a second old."""
        now = time.monotonic()
        if now - self._asked_at > FRESH_S and self._count:
            self._asked_at = now
            self._p99_ms = float(np.percentile(self._ring[: min(self._count, KEPT)], 99)) * 1e3
        return self._p99_ms


async def probe(lateness: Lateness) -> None:
    """Measure the lateness of a timer of the event loop, until cancelled."""
    while True:
        due = time.perf_counter() + PERIOD_S
        await asyncio.sleep(PERIOD_S)
        lateness.add(max(0.0, time.perf_counter() - due))
