"""One panel of one client: which ticks it shows and when its picture has changed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from core.board.history import FACTOR
from server.stream.codec import FROZEN, TRIGGERED, WAITING, PanelFrame
from server.stream.trigger import Samples, Trigger, crossing_time
from server.stream.wire import Subscribe


class History(Samples, Protocol):
    """The full-rate past of a bench."""

    def columns(self, signals: list[int], start: int, stop: int, columns: int) -> NDArray[np.float32]:
        """Return ``(n, 2, columns)`` minima and maxima."""


@dataclass(frozen=True)
class Span:
    """Columns of whole ticks.

    They begin at multiples of their width, so a column keeps its samples while the picture moves and
    nothing shimmers.
    """

    start: int
    end: int
    columns: int

    @classmethod
    def ending(cls, head: int, window: int, width: int) -> Span:
        """Cover the last ``window`` ticks before ``head``."""
        step = column_step(window, width)
        count = max(1, math.ceil(window / step))
        end = math.ceil(head / step) * step
        return cls(end - count * step, end, count)

    @classmethod
    def between(cls, start: int, end: int, width: int) -> Span:
        """Cover at least ``start`` to ``end``."""
        step = column_step(end - start, width)
        first = start // step * step
        count = max(1, math.ceil((end - first) / step))
        return cls(first, first + count * step, count)


def column_step(ticks: int, width: int) -> int:
    """Return the ticks of one column, so that ``width`` columns cover ``ticks``.

    Wide columns are whole buckets of the history, which is ten times cheaper; it costs a fifth of the
    columns at most.
    """
    step = max(1, math.ceil(ticks / width))
    for bucket in (FACTOR * FACTOR, FACTOR):
        if step >= 4 * bucket:
            return math.ceil(step / bucket) * bucket
    return step


class Panel:
    """A subscription turned into pictures.

    Parameters
    ----------
    spec : Subscribe
        What the client asked for.
    indices : list of int
        Columns of its signals in the history.
    trigger_index : int or None
        Column of the trigger's signal.
    revision : int
        Which subscription of this panel it is.
    dt_ms : float
        Device time of one tick.
    head : int
        First tick not computed yet.
    """

    def __init__(
        self,
        spec: Subscribe,
        indices: list[int],
        trigger_index: int | None,
        revision: int,
        dt_ms: float,
        head: int,
    ) -> None:
        self.spec, self.indices, self.revision = spec, indices, revision
        self._window = max(2, round((spec.window_ms or 0.0) / dt_ms))
        self._sent: tuple[object, ...] | None = None
        self._sweep = _Sweep(spec, trigger_index, self._window, head) if trigger_index is not None else None

    @property
    def points(self) -> int:
        """Columns times signals: what a picture costs."""
        return len(self.indices) * self.spec.width

    def rearm(self, head: int) -> None:
        """Take one more picture in single sweep."""
        if self._sweep is not None:
            self._sweep.rearm(head)

    def picture(self, history: History) -> PanelFrame | None:
        """Cut the picture, or nothing if it is the one already sent."""
        head, trigger, flags = history.end_tick, math.nan, 0
        if self.spec.mode == "frozen":
            assert self.spec.start_tick is not None and self.spec.end_tick is not None
            span = Span.between(self.spec.start_tick, self.spec.end_tick, self.spec.width)
            flags = FROZEN
            state: tuple[object, ...] = (min(head, span.end), head < span.start)
        elif self._sweep is not None:
            tick, flags = self._sweep.update(history)
            if tick is None:
                span = Span.ending(head, self._window, self.spec.width)
                if self.spec.trigger is not None and self.spec.trigger.sweep != "auto":
                    span = Span(head, head + span.end - span.start, span.columns)
                    state = (flags,)
                else:
                    state = (head, flags)
            else:
                start = tick - self._sweep.before
                step = column_step(self._window, self.spec.width)
                count = max(1, math.ceil(self._window / step))
                span = Span(start, start + count * step, count)
                trigger = self._sweep.exact(history, tick)
                state = (tick, flags)
        else:
            span = Span.ending(head, self._window, self.spec.width)
            state = (head,)
        if state == self._sent:
            return None
        self._sent = state
        return PanelFrame(
            panel=self.spec.panel,
            start=span.start,
            end=span.end,
            trigger=trigger,
            revision=self.revision,
            flags=flags,
            columns=history.columns(self.indices, span.start, span.end, span.columns),
            latest=_latest(history, self.indices),
        )


class _Sweep:
    """The time base of a triggered panel: which crossing is on show."""

    def __init__(self, spec: Subscribe, index: int, window: int, head: int) -> None:
        assert spec.trigger is not None
        self._spec, self._window = spec.trigger, window
        self.before = round(spec.trigger.position * window)
        # Begin where a whole window would still be in sight, so that a paused bench shows its last picture.
        start = head - 4 * window if spec.trigger.sweep != "single" else head
        self._trigger = Trigger(index, spec.trigger.edge, spec.trigger.level, spec.trigger.hysteresis, start)
        self._waiting: list[int] = []
        self._shown: int | None = None
        self._armed = True

    def rearm(self, head: int) -> None:
        """Wait for the next crossing."""
        if self._spec.sweep == "single":
            self._trigger.restart(head)
            self._waiting, self._armed = [], True

    def update(self, history: History) -> tuple[int | None, int]:
        """Return the crossing to show, if any, and the flags."""
        after = self._window - self.before
        if self._shown is not None and self._shown > history.end_tick:
            self._shown, self._waiting = None, []  # the bench went back in time
        if self._spec.sweep == "single":
            if self._armed and not self._waiting:
                self._waiting = self._trigger.scan(history, first_only=True)
        else:
            self._waiting += self._trigger.scan(history)
        complete = [tick for tick in self._waiting if tick + after <= history.end_tick]
        if complete:
            self._waiting = self._waiting[len(complete) :]
            self._shown = complete[-1]
            self._armed = self._spec.sweep != "single"
        if self._spec.sweep == "single":
            return self._shown, (WAITING if self._armed else 0) | (TRIGGERED if self._shown is not None else 0)
        late = self._shown is None or history.end_tick - self._shown > 2 * self._window + after
        if late:
            return (None if self._spec.sweep == "auto" else self._shown), WAITING
        return self._shown, TRIGGERED

    def exact(self, history: History, tick: int) -> float:
        """Place the crossing between ticks."""
        return crossing_time(history, self._trigger.index, tick, self._spec.level)


def _latest(history: History, indices: list[int]) -> NDArray[np.float32]:
    """Return the newest sample of each signal."""
    head = history.end_tick
    if head <= history.first_tick:
        return np.full(len(indices), np.nan, np.float32)
    return history.read(indices, head - 1, head)[:, 0]
