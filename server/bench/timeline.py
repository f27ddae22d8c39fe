"""The ticks of a bench: the board or tape that advances, and the history of its signals."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from core.board.board import Board
from core.board.history import History
from core.board.rows import Rows
from core.board.track import Deed, Track
from core.device.geometry import Geometry
from core.device.two_axis import TwoAxis
from core.signals import Signal
from scenarios.schema import Scenario
from server.bench.captures import Captures
from server.bench.moment import Branches, Moment
from server.bench.status import Origin
from server.bench.tick_source import TickSource

PAST_TICKS = 20_000
"""Ticks of the past that a fork brings along, or a jump that is undone."""
TRACK_BYTES = 8_000_000
"""Memory of the checkpoints from which the past is computed again; it is subtracted from the memory of the history."""
CAPTURE_BYTES = 2_500_000
"""Memory of the captures of users who see all of the bench, and the same again for users from whom a fault is hidden;
it is subtracted from the memory of the history."""
SLICE_S = 0.005
"""Longest slice, by the time of a tick; other benches and commands wait for it."""
MOST_SLOWER = 4.0
"""Most by which the estimated time of a tick grows at once: a longer tick has waited for a processor."""


class Timeline:
    """Advances a board or a tape in slices and keeps the history of its signals.

    Parameters
    ----------
    scenario : Scenario
        The scenario of the board.
    board : TickSource
        A board, or a recording that is played.
    history_ticks : int
        Ticks every signal is kept for.
    clock : callable
        The engine's clock.
    """

    origin: Origin | None = None
    """The moment of another bench from which it continues."""
    past_ticks = PAST_TICKS
    track_bytes = TRACK_BYTES

    def __init__(self, scenario: Scenario, board: TickSource, history_ticks: int, clock: Callable[[], float]) -> None:
        self.scenario, self.board = scenario, board
        self._history_ticks, self._clock = history_ticks, clock
        self._tick_s = SLICE_S / board.chunk
        self.history = self._empty_history()
        self._branches = Branches()
        self._index = {signal.name: signal.index for signal in board.signals}
        self.track = Track(board, self.track_bytes) if isinstance(board, Board) else None
        self.captures = Captures(self, CAPTURE_BYTES)

    @property
    def is_past(self) -> bool:
        """Whether it shows the moment it was forked at still: nothing was done, and no time has run."""
        origin, track = self.origin, self.track
        if origin is None or track is None:
            return False
        return self.board.tick == origin.tick and not track.has_deeds_since(origin.tick)

    @property
    def branch(self) -> int:
        """The branch of time of now."""
        return self._branches.current

    def has_in_past(self, branch: int, tick: int) -> bool:
        """Whether the ticks before a tick of a branch are in the past of the present state."""
        return self._branches.share(branch, tick)

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
        """The drawing of the device with its own gap; the drawing of the reference device if it has none."""
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

    def has_signals_of(self, board: TickSource) -> bool:
        """Whether a board has the signals of this one, and could take its place."""
        return [signal.name for signal in board.signals] == list(self._index)

    def _advance_slice(self, ticks: int) -> Rows:
        """Run ticks, as many as a slice has, and keep their rows in the history."""
        began = self._clock()
        rows = self.board.advance(min(ticks, max(1, int(SLICE_S / self._tick_s))))
        if rows.count:
            took = max(self._clock() - began, 1e-9)
            self._tick_s = min(took / rows.count, MOST_SLOWER * self._tick_s)
            self.history.append(rows)
            if self.track is not None and isinstance(self.board, Board):
                self.track.follow(self.board)
        return rows

    def done(self, deed: Deed) -> None:
        """Note an action on the board for the past."""
        if self.track is not None:
            self.track.note(deed)

    def done_otherwise(self) -> None:
        """Note for the past that the board has changed without a command."""
        if self.track is not None and isinstance(self.board, Board):
            self.track.mark(self.board, is_fixed=True)

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

    def moment(self, with_past: bool = False) -> Moment:
        """Return the present state of the bench, for a jump that empties the history with the past before it."""
        past = self._past(self.board.tick) if with_past else None
        return Moment(self.scenario, self.board.checkpoint(), self._branches.current, past)

    def track_to(self, moment: Moment) -> Track | None:
        """Return the track if it leads to a moment, so that the kept checkpoints are the past of the moment."""
        return self.track if self._branches.share(moment.branch, moment.checkpoint.tick) else None

    def _past(self, tick: int) -> Rows | None:
        """Return the last ticks before a tick, as far as the history has them."""
        first = max(self.history.first_tick, tick - self.past_ticks)
        if not first < tick <= self.history.end_tick:
            return None
        past = self.history.read(list(range(len(self._index))), first, tick).T
        return Rows.of(first, past, self.board.signals.outputs)

    def _be_again(self, moment: Moment) -> None:
        """Restore the state of the bench; of the past the history keeps the part that belongs to that moment."""
        board = Board.restore(moment.checkpoint)
        self.scenario, self.board, tick = moment.scenario, board, board.tick
        if self._branches.share(moment.branch, tick):
            self._rewind_history()
            if self.track is not None:
                self.track.go_back(board)
        else:
            self.history, self.track = self._empty_history(), Track(board, self.track_bytes)
        if moment.past is not None and self.history.end_tick != tick:
            self.history.append(moment.past)
        self._branches.begin(moment.branch, tick)

    def _begin_again(self, scenario: Scenario, board: Board) -> None:
        """Be another bench of the same signals, at tick 0."""
        self.scenario, self.board = scenario, board
        self.history, self.track = self._empty_history(), Track(board, self.track_bytes)
        self._branches.begin()
