"""Undo and redo: changes of a bench are taken back by commands at the tick of now, or by its journal before them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from core.board.board import Board
from core.board.changes import touched
from core.board.commands import Command, MakeSafe, ResetTrip, SetValues
from core.board.inverse import inverse
from core.board.pending import PendingCommand
from core.board.track import Deed
from core.errors import InputError
from server.bench.commands import MAX_PENDING, Redo, Undo
from server.bench.events import Event
from server.bench.journal import Journal
from server.bench.status import Undoable

if TYPE_CHECKING:
    from server.bench.bench import LiveBench

MOST, MOST_JOURNALS = 100, 3
"""Changes remembered; fewer of the changes that need a journal with its samples."""
AT_ONCE_S = 1.0
"""Values of the same parameters set within this time of each other, as by a slider, are one change."""


Way = list[Command | PendingCommand] | Journal
"""The way from one side of a change to the other: commands, commands that wait no more, or a journal to stand at."""


@dataclass(frozen=True)
class UndoableChange:
    """A change of a bench, and the way back from it."""

    shown: Undoable
    way: Way
    paths: frozenset[str] = frozenset()
    at: float = 0.0
    tick: int = 0


class Changes:
    """The changes of a bench that can be undone, and the undone changes.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    """

    def __init__(self, bench: LiveBench) -> None:
        self._bench = bench
        self._done: list[UndoableChange] = []
        self._undone: list[UndoableChange] = []

    @property
    def last_done(self) -> Undoable | None:
        """The change that is taken back next."""
        return self._done[-1].shown if self._done else None

    @property
    def last_undone(self) -> Undoable | None:
        """The change that is made again next."""
        return self._undone[-1].shown if self._undone else None

    def carry_out(self, command: Command | Undo | Redo, actor: str) -> Event:
        """Change the board, or let the change wait; take the last change back, or make it again.

        Raises
        ------
        InputError
            If the command cannot be carried out, and when too many wait. A change that can be taken back no more is
            forgotten then.
        """
        if isinstance(command, Undo):
            return self._move(self._done, self._undone, "undo", "undone", actor)
        if isinstance(command, Redo):
            return self._move(self._undone, self._done, "redo", "redone", actor)
        bench = self._bench
        if len(bench.board.pending) >= MAX_PENDING and not isinstance(command, MakeSafe):
            raise InputError(f"{MAX_PENDING} commands wait for their moment already", code="limit")
        event, way = self._apply(command, actor)
        paths = (
            frozenset(command.set) if isinstance(command, SetValues) and event.kind == SetValues.kind else frozenset()
        )
        self._remember(event, way, paths)
        bench.narration.tell()
        bench.time.fast_forward.end()
        bench.time.stop_if_tripped()
        return event

    def stand(self, journal: Journal, actor: str, kind: str, text: str, board: Board | None = None) -> Event:
        """Let the bench stand at the end of a journal, and remember the way back."""
        before = self._bench.journal(with_past=True)
        event = self._bench.stand(journal, actor, kind, text, board)
        self._remember(event, before)
        self._bench.refresh_status()
        return event

    def _move(
        self, source: list[UndoableChange], target: list[UndoableChange], kind: str, past: str, actor: str
    ) -> Event:
        if not source:
            raise InputError(f"there is nothing to {kind}", "kind", code="conflict")
        change = source.pop()
        text, way = f"{past}: {change.shown.text}", change.way
        if isinstance(way, Journal):
            before = self._bench.journal(with_past=True)
            event = self._bench.stand(way, actor, "restored", text)
            target.append(replace(change, way=before, tick=self._bench.board.tick))
            return event
        try:
            self._check_unsupervised(change)
            back = self._go(way, actor)
        except InputError as error:
            refusal = f"{change.shown.text} can no more be {past}: {error}"
            raise InputError(refusal, "kind", error.hint, "conflict") from None
        target.append(replace(change, way=back, tick=self._bench.board.tick))
        return self._bench.note(actor, past, text)

    def _check_unsupervised(self, change: UndoableChange) -> None:
        """Refuse to take back a change of a value that the supervisor has set since."""
        board = self._bench.board
        if not isinstance(board, Board):
            return
        board.obey()
        since = [one.command for one in board.consequences if one.tick > change.tick]
        steps = [step.command if isinstance(step, PendingCommand) else step for step in change.way]  # type: ignore[union-attr]
        own, its = ({path for one in part for path in touched(board.spec, one)} for part in (steps, since))
        if both := sorted(own & its):
            raise InputError(f"the supervisor has set {both[0]} since", hint="set it by hand")

    def _go(self, way: list[Command | PendingCommand], actor: str) -> Way:
        """Carry out as much of a way as possible; return the way back."""
        back: list[Command | PendingCommand] = []
        refusal: InputError | None = None
        for step in way:
            try:
                found = self._step(step, actor)
            except InputError as error:
                refusal = error
                continue
            if isinstance(found, Journal):
                return found
            back = found + back
        if refusal is not None and not back:
            raise refusal
        return back

    def _step(self, step: Command | PendingCommand, actor: str) -> Way:
        bench = self._bench
        if not isinstance(step, PendingCommand):
            return self._apply(step, actor)[1]
        if step not in bench.board.pending:
            raise InputError("it waits no more")
        bench.board.pending.remove(step)
        bench.done(Deed(bench.board.tick, None, actor, step.number))
        return [step.command]

    def _apply(self, command: Command, actor: str) -> tuple[Event, Way]:
        """Carry out a command; return its event and the way back."""
        board = self._bench.board
        if isinstance(board, Board):
            board.obey()  # an act at this tick comes first, and its values are the values before the command
        before = board.spec.document
        tripped: Journal | None = None
        if isinstance(command, ResetTrip) and board.trip is not None:
            tripped = self._bench.journal(with_past=True)
        event = board.apply(command, actor)
        self._bench.done(Deed(board.tick, command, actor))
        assert isinstance(event, Event)
        if event.kind == "scheduled":
            return event, [max(board.pending, key=lambda entry: entry.number)]
        return event, tripped if tripped is not None else [*inverse(command, event, before)]

    def _remember(self, event: Event, way: Way, paths: frozenset[str] = frozenset()) -> None:
        """Put a change on top; changes that were undone before cannot be redone."""
        self._undone.clear()
        if not way:
            return
        now, last = self._bench.clock(), self._done[-1] if self._done else None
        if last is not None and paths and last.paths == paths and now - last.at < AT_ONCE_S:
            way = self._done.pop().way
        self._done.append(
            UndoableChange(Undoable(seq=event.seq, text=event.text), way, paths, now, self._bench.board.tick)
        )
        journals = [i for i, change in enumerate(self._done) if isinstance(change.way, Journal)]
        first = journals[-MOST_JOURNALS - 1] + 1 if len(journals) > MOST_JOURNALS else 0
        self._done = self._done[max(first, len(self._done) - MOST) :]
