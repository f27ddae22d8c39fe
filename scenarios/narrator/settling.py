"""Whether the error comes back after something was done."""

from __future__ import annotations

from collections.abc import Iterator

from scenarios.narrator.doings import MEASURED, MODEL, SPAN
from scenarios.narrator.samples import LastSamples, rms
from scenarios.narrator.sentence import Sentence
from scenarios.narrator.words import figure, length, moment

BAND = 0.05
"""Share of the motion of the model under which an error counts as settled."""


class Settling:
    r"""Tells when the error is back after the last fault, healing or switch.

    From there on the root mean squares of the measured error :math:`y_m-y` and of the model :math:`y_m` are taken over
    100 ticks after 100 ticks. Once the error has been over 5 % of the model, the first 100 ticks under it are told. A
    trip ends it.

    Parameters
    ----------
    dt_ms : float
        Device time of a tick.
    """

    def __init__(self, dt_ms: float) -> None:
        self._dt_ms = dt_ms
        self._after: tuple[int, str] | None = None
        self._at, self._was_over = 0, False

    def follow(self, told: Sentence) -> None:
        """Follow what comes of what was told."""
        self._after = None if told.kind == "trip" else (told.tick, "healing" if told.kind == "heal" else told.kind)
        self._at, self._was_over = told.tick, False

    def look(self, samples: LastSamples, until: int) -> Iterator[Sentence]:
        """Tell whether the error came back before a tick."""
        if MODEL not in samples or MEASURED not in samples:
            return
        while self._after is not None and self._at + SPAN <= until:
            first, self._at = self._at, self._at + SPAN
            model = samples.values(MODEL, first, self._at)
            error, limit = rms(model - samples.values(MEASURED, first, self._at)), BAND * rms(model)
            if error > limit:
                self._was_over = True
            elif self._was_over and error <= limit:
                yield self._sentence(error, limit)
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
                f"At {moment(tick * self._dt_ms)} the error is back under {figure(limit, 'um')}, 5 % of the motion: "
                f"{figure(error, 'um')} (RMS), {length(took)} after the {what}."
            ),
            signals=[MODEL, MEASURED],
            span=(since, tick),
            numbers=numbers,
        )
