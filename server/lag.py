"""How late the event loop is: the age everything on it inherits."""

from __future__ import annotations

import asyncio
import time
from collections import deque

import numpy as np

from server.metrics import Metrics

PERIOD_S = 0.02
KEPT = 3000
"""Probes kept: one minute."""


class LagProbe:
    """A timer that measures by how much it is late.

    Parameters
    ----------
    metrics : Metrics
        Where each measurement is observed.
    """

    def __init__(self, metrics: Metrics) -> None:
        self._metrics = metrics
        self._lags: deque[float] = deque(maxlen=KEPT)

    async def run(self) -> None:
        """Measure until cancelled."""
        while True:
            due = time.perf_counter() + PERIOD_S
            await asyncio.sleep(PERIOD_S)
            lag = max(0.0, time.perf_counter() - due)
            self._lags.append(lag)
            self._metrics.loop_lag.observe(lag)

    def p99_ms(self) -> float:
        """Return the 99th percentile over the last minute."""
        return float(np.percentile(list(self._lags), 99)) * 1e3 if self._lags else 0.0
