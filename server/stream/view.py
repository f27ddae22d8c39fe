"""Pictures of panels: the ticks they cover, and when they change. Pages with the same subscription share a view."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from core.board.pyramid import FACTOR
from server.bench.captures import MOST, CaptureSet
from server.stream.behind import Behind
from server.stream.codec import FROZEN, TRIGGERED, WAITING, Picture
from server.stream.trigger import Trigger, TriggerSamples, crossing_time
from server.stream.wire import Subscribe


class FullHistory(TriggerSamples, Protocol):
    """The full-rate past of a bench."""

    def columns(self, signals: list[int], start: int, stop: int, columns: int) -> NDArray[np.float32]:
        """Return ``(n, 2, columns)`` minima and maxima."""

    def capture(self, captures: CaptureSet, tick: int, at: float) -> None:
        """Keep the window around a crossing."""


@dataclass(frozen=True)
class TickSpan:
    """Columns of whole ticks.

    They begin at multiples of their width, so a column keeps its samples while the picture moves and
    nothing shimmers.
    """

    start: int
    end: int
    columns: int

    @classmethod
    def ending(cls, head: int, window: int, width: int) -> TickSpan:
        """Cover the last ``window`` ticks before ``head``."""
        step = column_step(window, width)
        count = max(1, math.ceil(window / step))
        end = math.ceil(head / step) * step
        return cls(end - count * step, end, count)

    @classmethod
    def between(cls, start: int, end: int, width: int) -> TickSpan:
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


def window_of(spec: Subscribe, dt_ms: float) -> tuple[int, int]:
    """Return the ticks of a window, and how many of them are before the trigger."""
    window = max(2, round((spec.window_ms or 0.0) / dt_ms))
    return window, round(spec.trigger.position * window) if spec.trigger is not None else 0


class _State(NamedTuple):
    """Identifies a picture: its kind, a tick that differs for others of that kind, its flags, the benches behind it."""

    kind: Literal["frozen", "rolling", "triggered", "empty"]
    tick: int
    flags: int
    behind: tuple[tuple[int, int], ...] = ()


class PictureCutter:
    """Cuts the pictures of a subscription.

    Parameters
    ----------
    spec : Subscribe
        The subscription.
    indices : list of int
        Columns of its signals in the history.
    trigger_index : int or None
        Column of the trigger's signal.
    dt_ms : float
        Device time of one tick.
    head : int
        First tick not computed yet.
    behind : sequence of Behind
        Other benches that are shown behind the picture.
    captures : CaptureSet, optional
        The captures around the crossings of the trigger; a triggered view adds to them, a frozen view reads them.
    """

    def __init__(
        self,
        spec: Subscribe,
        indices: list[int],
        trigger_index: int | None,
        dt_ms: float,
        head: int,
        behind: Sequence[Behind] = (),
        captures: CaptureSet | None = None,
    ) -> None:
        self.spec, self.indices, self._behind, self.captures = spec, indices, behind, captures
        if captures is not None:
            captures.views.add(self)
        self._window, before = window_of(spec, dt_ms)
        self._sweep: _Sweep | None = None
        if trigger_index is not None and spec.mode == "triggered":
            self._sweep = _Sweep(spec, trigger_index, self._window, before, head)
        self._frozen: TickSpan | None = None
        if spec.mode == "frozen" and spec.start_tick is not None and spec.end_tick is not None:
            self._frozen = TickSpan.between(spec.start_tick, spec.end_tick, spec.width)
        self._state: _State | None = None
        self._picture: Picture | None = None

    @property
    def behind(self) -> tuple[tuple[int, int], ...]:
        """Dependencies on the pictures of other benches."""
        return tuple(one.state for one in self._behind)

    def rearm(self, head: int) -> None:
        """Take one more picture in single sweep."""
        if self._sweep is not None:
            self._sweep.rearm(head)

    def forget(self) -> None:
        """Take a new picture even of the same ticks, because their samples may have changed."""
        self._state = None

    def find(self, history: FullHistory) -> None:
        """Find captures, also while no page takes a picture."""
        if self._sweep is not None:
            self._find(history, self._sweep)

    def _find(self, history: FullHistory, sweep: _Sweep) -> tuple[int | None, int]:
        """Return the crossing to show, if any, and the flags; windows that are complete are captured."""
        shown = sweep.update(history)
        if self.captures is not None:
            for tick in sweep.complete:
                if self.captures.wants(tick):
                    history.capture(self.captures, tick, sweep.exact(history, tick))
        return shown

    def picture(self, history: FullHistory) -> Picture:
        """Return the picture of now; the same object while nothing in it changes."""
        state = self._look(history)._replace(behind=self.behind)
        if self._picture is None or state != self._state:
            self._state = state
            span, trigger = self._span(history, state)
            own = history.columns(self.indices, span.start, span.end, span.columns)
            others = [one.columns(span.start, span.end, span.columns) for one in self._behind]
            latest = _latest(history, self.indices)
            nothing = np.full(len(latest) * len(others), np.nan, np.float32)
            self._picture = Picture(
                start=span.start,
                end=span.end,
                trigger=trigger,
                flags=state.flags,
                columns=np.concatenate([own, *others]) if others else own,
                latest=np.concatenate([latest, nothing]) if others else latest,
            )
        return self._picture

    def _look(self, history: FullHistory) -> _State:
        """Return the key of the picture of now: pictures differ if and only if their keys differ."""
        head = history.end_tick
        if self._frozen is not None:
            return _State("frozen", min(max(head, self._frozen.start), self._frozen.end), FROZEN)
        if self._sweep is None:
            return _State("rolling", head, 0)
        tick, flags = self._find(history, self._sweep)
        if tick is not None:
            return _State("triggered", tick, flags)
        return _State("rolling", head, flags) if self._sweep.is_auto else _State("empty", 0, flags)

    def _span(self, history: FullHistory, state: _State) -> tuple[TickSpan, float]:
        """Return the columns of a picture, and where it was triggered."""
        if self._frozen is not None:
            return self._frozen, math.nan
        if state.kind == "triggered":
            assert self._sweep is not None
            start = state.tick - self._sweep.before
            step = column_step(self._window, self.spec.width)
            count = max(1, math.ceil(self._window / step))
            return TickSpan(start, start + count * step, count), self._sweep.exact(history, state.tick)
        span = TickSpan.ending(history.end_tick, self._window, self.spec.width)
        if state.kind == "empty":  # behind the newest tick
            span = TickSpan(history.end_tick, history.end_tick + span.end - span.start, span.columns)
        return span, math.nan


class _Sweep:
    """The time base of a triggered panel: it chooses the crossing to show."""

    def __init__(self, spec: Subscribe, index: int, window: int, before: int, head: int) -> None:
        assert spec.trigger is not None
        self._spec, self._window, self.before = spec.trigger, window, before
        # Begin before the newest tick, so that a paused bench shows its last picture, and captures that came before.
        start = head - (MOST + 1) * window if spec.trigger.sweep != "single" else head
        wanted = spec.trigger
        upper = math.inf if wanted.upper is None else wanted.upper
        self._trigger = Trigger(index, wanted.edge, wanted.level, wanted.hysteresis, start, upper)
        self._waiting: list[int] = []
        self.complete: list[int] = []
        """Crossings whose windows have become complete with the last update."""
        self._shown: int | None = None
        self._armed = True

    @property
    def is_auto(self) -> bool:
        """Whether the picture rolls while nothing triggers."""
        return self._spec.sweep == "auto"

    def rearm(self, head: int) -> None:
        """Wait for the next crossing."""
        if self._spec.sweep == "single":
            self._trigger.restart(head)
            self._waiting, self._armed = [], True

    def update(self, history: FullHistory) -> tuple[int | None, int]:
        """Return the crossing to show, if any, and the flags."""
        after = self._window - self.before
        if self._shown is not None and self._shown > history.end_tick:
            self._shown, self._waiting = None, []  # the bench went back in time
        if self._spec.sweep == "single":
            if self._armed and not self._waiting:
                self._waiting = self._trigger.scan(history, first_only=True)
        else:
            self._waiting += self._trigger.scan(history)
        self.complete = [tick for tick in self._waiting if tick + after <= history.end_tick]
        if self.complete:
            self._waiting = self._waiting[len(self.complete) :]
            self._shown = self.complete[-1]
            self._armed = self._spec.sweep != "single"
        if self._spec.sweep == "single":
            return self._shown, (WAITING if self._armed else 0) | (TRIGGERED if self._shown is not None else 0)
        late = self._shown is None or history.end_tick - self._shown > 2 * self._window + after
        if late:
            return (None if self._spec.sweep == "auto" else self._shown), WAITING
        return self._shown, TRIGGERED

    def exact(self, history: FullHistory, tick: int) -> float:
        """Return the tick of the crossing, between whole ticks."""
        return crossing_time(history, self._trigger.index, tick, self._spec.level, self._trigger.upper)


def _latest(history: FullHistory, indices: list[int]) -> NDArray[np.float32]:
    """Return the newest sample of each signal."""
    head = history.end_tick
    if head <= history.first_tick:
        return np.full(len(indices), np.nan, np.float32)
    return history.read(indices, head - 1, head)[:, 0]
