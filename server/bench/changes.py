"""Changes of a bench: taken back and made again, by commands at the tick of now or by going back in time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from core.board.commands import Command, ResetTrip, Set
from core.board.inverse import inverse
from core.board.pending import Pending
from core.board.track import Deed
from core.errors import InputError
from server.bench.events import Event
from server.bench.live_bench import LiveBench
from server.bench.moment import Moment
from server.bench.status import Undoable

MOST, MOST_MOMENTS = 100, 3
"""Changes remembered; fewer of the changes that need a whole moment with a past."""
AT_ONCE_S = 1.0
"""Values of the same parameters set within this time of each other, as by a slider, are one change."""


class ChangingBench(LiveBench, Protocol):
    """A bench whose changes can be taken back."""

    def moment(self, with_past: bool = False) -> Moment:
        """Return the present state of the bench, for a jump that empties the history with the past before it."""

    def go_to(self, moment: Moment) -> None:
        """Restore the state of the bench."""

    def done(self, deed: Deed) -> None:
        """Note an action on the board for the past."""


Way = list[Command | Pending | Moment]
"""The way from one side of a change to the other: commands, commands that wait no more, or a moment."""


@dataclass(frozen=True)
class Change:
    """A change of a bench, and the way back from it."""

    shown: Undoable
    way: Way
    paths: frozenset[str] = frozenset()
    at: float = 0.0


class Changes:
    """The changes of a bench that can be undone, and the undone changes.

    Parameters
    ----------
    bench : ChangingBench
        The bench.
    clock : callable
        The engine's clock.
    """

    def __init__(self, bench: ChangingBench, clock: Callable[[], float]) -> None:
        self._bench, self._clock = bench, clock
        self._done: list[Change] = []
        self._undone: list[Change] = []

    @property
    def last_done(self) -> Undoable | None:
        """The change that is taken back next."""
        return self._done[-1].shown if self._done else None

    @property
    def last_undone(self) -> Undoable | None:
        """The change that is made again next."""
        return self._undone[-1].shown if self._undone else None

    def apply(self, command: Command, actor: str) -> Event:
        """Carry out a command, or let it wait, and remember the way back."""
        event, way = self._carry_out(command, actor)
        paths = frozenset(command.set) if isinstance(command, Set) and event.kind == Set.kind else frozenset()
        self._remember(event, way, paths)
        return event

    def jumped(self, event: Event, before: Moment) -> None:
        """Remember a reset or a return to another moment."""
        self._remember(event, [before])

    def back(self, actor: str) -> Event:
        """Take the last change back.

        Raises
        ------
        InputError
            When there is none, or it can be taken back no more; it is forgotten then.
        """
        return self._move(self._done, self._undone, "undo", "undone", actor)

    def again(self, actor: str) -> Event:
        """Make the change that was taken back last again."""
        return self._move(self._undone, self._done, "redo", "redone", actor)

    def _move(self, source: list[Change], target: list[Change], kind: str, past: str, actor: str) -> Event:
        if not source:
            raise InputError(f"there is nothing to {kind}", "kind", code="conflict")
        change = source.pop()
        try:
            way = self._go(change.way, actor)
        except InputError as error:
            text = f"{change.shown.text} can no more be {past}: {error}"
            raise InputError(text, "kind", error.hint, "conflict") from None
        target.append(Change(change.shown, way))
        text = f"{past}: {change.shown.text}"
        moments = [step for step in change.way if isinstance(step, Moment)]
        if moments:
            tick = self._bench.board.tick
            return self._bench.events.add(tick, actor, "restored", text, new=moments[0].last_event)
        return self._bench.note(actor, past, text)

    def _go(self, way: Way, actor: str) -> Way:
        """Go a way as far as it can be gone; return the way back."""
        back: Way = []
        refusal: InputError | None = None
        for step in way:
            try:
                back = self._step(step, actor) + back
            except InputError as error:
                refusal = error
        if refusal is not None and not back:
            raise refusal
        return back

    def _step(self, step: Command | Pending | Moment, actor: str) -> Way:
        bench = self._bench
        if isinstance(step, Moment):
            before = bench.moment(with_past=True)
            bench.go_to(step)
            return [before]
        if isinstance(step, Pending):
            if step not in bench.board.pending:
                raise InputError("it waits no more")
            bench.board.pending.remove(step)
            bench.done(Deed(bench.board.tick, None, actor, step.number))
            return [step.command]
        return self._carry_out(step, actor)[1]

    def _carry_out(self, command: Command, actor: str) -> tuple[Event, Way]:
        """Carry out a command; return its event and the way back."""
        board = self._bench.board
        before = board.spec.document
        tripped: Moment | None = None
        if isinstance(command, ResetTrip) and board.trip is not None:
            tripped = self._bench.moment(with_past=True)
        event = board.apply(command, actor)
        self._bench.done(Deed(board.tick, command, actor))
        assert isinstance(event, Event)
        if event.kind == "scheduled":
            return event, [max(board.pending, key=lambda entry: entry.number)]
        return event, [tripped] if tripped is not None else [*inverse(command, event, before)]

    def _remember(self, event: Event, way: Way, paths: frozenset[str] = frozenset()) -> None:
        """Put a change on top; changes that were undone before cannot be redone."""
        self._undone.clear()
        if not way:
            return
        now, last = self._clock(), self._done[-1] if self._done else None
        if last is not None and paths and last.paths == paths and now - last.at < AT_ONCE_S:
            way = self._done.pop().way
        self._done.append(Change(Undoable(seq=event.seq, text=event.text), way, paths, now))
        moments = [i for i, change in enumerate(self._done) if isinstance(change.way[0], Moment)]
        first = moments[-MOST_MOMENTS - 1] + 1 if len(moments) > MOST_MOMENTS else 0
        self._done = self._done[max(first, len(self._done) - MOST) :]
