"""Whether the error comes back after something was done."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from core.block import FloatArray
from core.kernel import kernel
from scenarios.narrator.doings import MEASURED, MODEL, SPAN
from scenarios.narrator.samples import NarratorSignals
from scenarios.narrator.sentence import Sentence
from scenarios.narrator.words import figure, length, moment

OVER, BACK = 0.05, 0.025
"""Shares of the motion of the model: over the first an error has left, under the second it is back.

They differ, so that an error at the edge never counts as back, as in open loop while the fault acts.
"""
COUNT, ERROR, MOTION, WAS_OVER = range(4)
"""Samples of the block under way, the sums of its squares, and whether one was over the limit."""


@kernel
def _settle(model: FloatArray, measured: FloatArray, sums: FloatArray, span: int, over: float, back: float) -> int:
    """Add samples up, block by block; return how many there are to the end of the block that settles, or 0."""
    for i in range(len(model)):
        if sums[COUNT] == span:
            sums[COUNT] = sums[ERROR] = sums[MOTION] = 0.0
        error = model[i] - measured[i]
        sums[COUNT] += 1.0
        sums[ERROR] += error * error
        sums[MOTION] += model[i] * model[i]
        if sums[COUNT] == span:
            if sums[ERROR] > over * over * sums[MOTION]:
                sums[WAS_OVER] = 1.0
            elif sums[WAS_OVER] != 0.0 and sums[ERROR] <= back * back * sums[MOTION]:
                return i + 1
    return 0


class Settling:
    r"""Tells when the error is back after the last fault, healing or switch.

    From there on the root mean squares of the measured error :math:`y_m-y` and of the model :math:`y_m` are taken over
    100 ticks after 100 ticks. Once the error has been over 5 % of the model, the first 100 ticks under 2.5 % of it give
    a sentence. A trip ends it.

    Parameters
    ----------
    dt_ms : float
        Device time of a tick.
    """

    def __init__(self, dt_ms: float) -> None:
        self._dt_ms = dt_ms
        self._after: tuple[int, str] | None = None
        self._at, self._sums = 0, np.zeros(4)

    def follow(self, told: Sentence) -> None:
        """Follow the settling after a sentence."""
        self._after = None if told.kind == "trip" else (told.tick, "healing" if told.kind == "heal" else told.kind)
        self._at, self._sums = told.tick, np.zeros(4)

    def look(self, samples: NarratorSignals, until: int) -> Iterator[Sentence]:
        """Tell whether the error came back before a tick."""
        if self._after is None or self._at >= until or MODEL not in samples or MEASURED not in samples:
            return
        model, measured = (samples.values(name, self._at, until) for name in (MODEL, MEASURED))
        self._sums = self._sums.copy()  # a copy of this continues independently
        settled = _settle(model, measured, self._sums, SPAN, OVER, BACK)
        self._at = self._at + settled if settled else until
        if settled:
            error, motion = (math.sqrt(self._sums[which] / SPAN) for which in (ERROR, MOTION))
            yield self._sentence(error, BACK * motion)
            self._after = None

    def _sentence(self, error: float, limit: float) -> Sentence:
        assert self._after is not None
        (since, what), tick = self._after, self._at - 1
        took = (self._at - since) * self._dt_ms
        numbers = {"time_ms": tick * self._dt_ms, "error_um": error, "limit_um": limit, "settling_ms": took}
        return Sentence(
            tick=tick,
            kind="settled",
            text=(
                f"At {moment(tick * self._dt_ms)} the error is back under {figure(limit, 'um')}, 2.5 % of the motion: "
                f"{figure(error, 'um')} (RMS), {length(took)} after the {what}."
            ),
            signals=[MODEL, MEASURED],
            span=(since, tick),
            numbers=numbers,
        )
