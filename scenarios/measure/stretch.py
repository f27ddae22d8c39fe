"""The input of figures of a run: a part of the run, and a diagnoser for comparison."""

from __future__ import annotations

from pydantic import Field

from core.board.commands import LONGEST_MS
from core.table import Table

TAIL = 0.25
"""Share of a run that counts as its tail."""


class Stretch(Table):
    """The options ``[metrics]`` of a scenario."""

    since_ms: float = Field(0.0, ge=0, le=LONGEST_MS, description="moment that errors and settling count from, ms")
    tail_share: float = Field(TAIL, gt=0, le=1, description="share of the run that counts as its tail")
    steps: bool = Field(False, description="errors of each step between faults, and the times to recover from them")
    beside: str = Field("", max_length=200, description="diagnoser over whose delays the delays of others are taken")
    estimation: bool = Field(False, description="whether weighted estimates run headless too, for their figures")

    def start(self, samples: int, dt_ms: float) -> int:
        """Return the first of a number of samples that counts; the last sample if the run ends before it."""
        return min(round(self.since_ms / dt_ms), samples - 1)

    def tail(self, samples: int) -> slice:
        """Return the tail of a number of samples, at least one."""
        return slice(min(int(samples * (1.0 - self.tail_share)), samples - 1), None)
