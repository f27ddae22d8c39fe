"""When the blocks of an instrument came, and when a board had played them."""

from __future__ import annotations

from collections import deque

KEPT = 1000
"""Blocks that are remembered."""
MEASURED_S = 2.0
"""Time over which the rate is measured."""


class Arrivals:
    """The rate of an instrument, and the time from the arrival of a block to its last verdict.

    All times are seconds of one clock, which the callers read.
    """

    def __init__(self) -> None:
        self._came: deque[tuple[int, float]] = deque(maxlen=KEPT)
        self._waiting: deque[tuple[int, float]] = deque(maxlen=KEPT)
        self._took_ms: deque[float] = deque(maxlen=KEPT)

    def came(self, end: int, now: float) -> None:
        """Note a block that ends before a sample."""
        self._came.append((end, now))
        self._waiting.append((end, now))

    def played(self, tick: int, now: float) -> None:
        """Note that a board has played all samples before a tick."""
        while self._waiting and self._waiting[0][0] <= tick:
            self._took_ms.append(1e3 * (now - self._waiting.popleft()[1]))

    def lag_ms(self, now: float) -> float:
        """Return for how long the oldest block waits that is not played."""
        waiting = next(iter(self._waiting.copy()), None)
        return 1e3 * (now - waiting[1]) if waiting is not None else 0.0

    @property
    def latency_p95_ms(self) -> float | None:
        """The 95th percentile of the time from arrival to verdict, ms; none before the first verdict."""
        took = sorted(self._took_ms.copy())
        return took[min(len(took) - 1, int(0.95 * len(took)))] if took else None

    def rate_khz(self, now: float) -> float:
        """Return the samples for each ms that came lately."""
        recent = [one for one in self._came.copy() if now - one[1] <= MEASURED_S]
        if len(recent) < 2 or recent[-1][1] <= recent[0][1]:
            return 0.0
        return (recent[-1][0] - recent[0][0]) / (1e3 * (recent[-1][1] - recent[0][1]))
