"""The ticks of a bench: the board or tape that advances, and the history of its signals."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from core.board.history import History
from core.board.rows import Rows
from core.device.geometry import Geometry
from core.device.two_axis import TwoAxis
from core.signals import Signal
from server.bench.tick_source import TickSource

SLICE_S = 0.005
"""Longest slice, by what a tick of the one before took; other benches and commands wait for it."""


class Timeline:
    """Advances a board or a tape in slices and keeps the history of its signals.

    Parameters
    ----------
    board : TickSource
        A board, or a recording that is played.
    history_ticks : int
        Ticks every signal is kept for.
    clock : callable
        The engine's clock.
    """

    def __init__(self, board: TickSource, history_ticks: int, clock: Callable[[], float]) -> None:
        self.board = board
        self._history_ticks, self._clock = history_ticks, clock
        self._slice_ticks = board.chunk
        self.history = self._empty_history()
        self._index = {signal.name: signal.index for signal in board.signals}

    @property
    def now(self) -> float:
        """The time on the engine's clock."""
        return self._clock()

    @property
    def dt_ms(self) -> float:
        """Device time of one tick."""
        return self.board.dt_ms

    @property
    def signals(self) -> Sequence[Signal]:
        """All signals, in the order of the history."""
        signals: Sequence[Signal] = self.board.signals
        return signals

    @property
    def geometry(self) -> Geometry:
        """The drawing of the device with its own gap; that of the reference device if it has none."""
        return self.board.spec.device.drawing

    @property
    def drive_period_ticks(self) -> float | None:
        """Period of the reference in ticks, if it has one; of the driven axis where the plant has axes."""
        spec = self.board.spec
        if isinstance(spec.nominal, TwoAxis):
            return 2.0 * math.pi / (spec.nominal.drive_frequency * self.dt_ms)
        frequency = getattr(spec.reference.params, "frequency_hz", None)
        return 1e3 / (float(frequency) * self.dt_ms) if isinstance(frequency, int | float) and frequency else None

    @property
    def column_of(self) -> dict[str, int]:
        """Column of each signal by name."""
        return self._index

    def indices(self, names: Sequence[str]) -> list[int]:
        """Return the columns of signals; an unknown name is an `InputError` with suggestions."""
        return [self.board.signals.index(name) for name in names]

    def _advance_slice(self, ticks: int) -> Rows:
        """Run ticks, as many as a slice has, and keep their rows in the history."""
        began = self._clock()
        rows = self.board.advance(min(ticks, self._slice_ticks))
        if rows.count:
            took = max(self._clock() - began, 1e-9)
            self._slice_ticks = max(1, int(SLICE_S * rows.count / took))
            self.history.append(rows)
        return rows

    def _has_due(self) -> bool:
        """Whether a command of the scenario is due at this very tick, such as the reset of a trip."""
        due = self.board.pending.next_tick
        return due is not None and due <= self.board.tick

    def _empty_history(self) -> History:
        """Return a history with nothing in it."""
        signals = self.board.signals
        return History(signals.outputs, len(signals.taps), self._history_ticks)

    def _rewind_history(self) -> None:
        """Let the history follow a jump of the tick."""
        if self.history.first_tick <= self.board.tick <= self.history.end_tick:
            self.history.end_tick = self.board.tick
        else:
            self.history = self._empty_history()

    def _copy_past(self, other: Timeline, ticks: int) -> None:
        """Take over the last ticks before this moment from the history of another timeline."""
        tick = self.board.tick
        first = max(other.history.first_tick, tick - ticks)
        if first < tick <= other.history.end_tick:
            past = other.history.read(list(range(len(self._index))), first, tick).T
            self.history.append(Rows.of(first, past, self.board.signals.outputs))
