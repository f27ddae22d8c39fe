"""A board: one tick after another, commands at tick edges, a log of all that happened."""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from core.block import BlockParams, BoolArray, FloatArray
from core.board import changes, fold, kept, program, supervision, words
from core.board.commands import Command, Trip
from core.board.condition import Condition, parse_condition
from core.board.document import SUPERVISOR, Document
from core.board.fold import Words
from core.board.history import History
from core.board.kept import KeptTicks
from core.board.log import Log, LogEntry
from core.board.lost import EVERY, Lost, lost, next_look
from core.board.observer import Finding, Observer
from core.board.parse import parse
from core.board.pending import PendingCommand, PendingQueue
from core.board.rows import Rows
from core.board.scoring import scores
from core.board.segments import SharedSegment
from core.board.spec import Section, Spec
from core.board.supervision import Consequence
from core.board.walk import Walk
from core.board.wiring import Wiring, wire
from core.errors import InputError
from core.loop.score import Scores
from core.plant.record import playable, supply
from core.ports import RESERVED
from core.signals import SignalTable

CHUNK = 512
"""Most ticks of one call of ``advance``."""
COPIED = ("pending", "trip", "wiring", "folds", "used", "observer")
LISTS = 150
"""Bytes that a checkpoint takes for each block beside its numbers."""
SHARED = ("spec", "base", "compiled", "fuses", "tick", "lost", "estimates")
"""Parts that every copy of a board has for itself (``COPIED``), and parts that never change in place (``SHARED``)."""


@dataclass(frozen=True)
class Checkpoint:
    """Everything a board is, at a tick edge."""

    tick: int
    kind: type[Board]
    parts: dict[str, Any] = field(repr=False)


class Board:
    """A wired bench.

    Parameters
    ----------
    bench : dict or Spec
        The bench: its document, or the spec that was read from it. A board never changes a spec in place, so
        that several may be built from one.
    compiled : bool
        Run compiled blocks; the uncompiled ones are their oracle and give the same bits.
    """

    chunk = CHUNK
    estimates = False
    """Whether the weighted estimates are asked for, so that they run though nothing reads them."""

    def __init__(self, bench: Document | Spec, *, compiled: bool = True) -> None:
        self.spec: Spec = bench if isinstance(bench, Spec) else parse(bench)
        self.base: Document = copy.deepcopy(self.spec.document)
        self.compiled, self.fuses = compiled, False
        self.wiring: Wiring = wire(self.spec)
        self.tick = 0
        self.log = Log()  # a live bench replaces it with its own log
        self.done: list[tuple[int, Command]] = []  # each with the tick at which it took effect
        self.consequences: list[Consequence] = []  # acts of the supervisor; a replay derives them
        self.pending = PendingQueue()
        self.trip: Trip | None = None
        self.lost: Lost | None = None
        self.folds = fold.begin(self.wiring.signals.outputs)
        self.used: set[str] = set()
        self.observer = Observer(self.spec, self.wiring)
        self.walk = Walk(self.wiring, compiled=compiled)
        self._allocate()
        self.link()

    # -- properties

    @property
    def dt_ms(self) -> float:
        """Sample interval, ms."""
        return self.spec.dt_ms

    @property
    def faults(self) -> dict[str, BlockParams]:
        """The faults that act, by name."""
        return self.spec.faults

    @property
    def signals(self) -> SignalTable:
        """Table of traced signals."""
        return self.wiring.signals

    @property
    def diagnosers(self) -> dict[str, Section]:
        """Every diagnoser by its id."""
        return self.spec.diagnosers

    @property
    def nbytes(self) -> int:
        """Memory that a checkpoint takes."""
        wiring = self.wiring
        numbers = sum(part.nbytes for part in (wiring.p, wiring.s, wiring.w, wiring.io, wiring.table, self.folds))
        return numbers + LISTS * len(wiring.instances)

    @property
    def unfused(self) -> list[SharedSegment]:
        """The segments of a board that fuses whose code is not loaded."""
        return [segment for segment in self.walk.awaited if not segment.address]

    def value(self, signal: str) -> float:
        """Return the value of a signal after the last tick."""
        return float(self.wiring.w[self.wiring.index[signal]])

    def digest(self) -> str:
        """Return the SHA-256 over one fold for each block, of the bits of its outputs at every tick so far.

        Controllers that have not driven yet and sensors that have not been in use do not count: they do not act
        on the loop.
        """
        aside = {*self.spec.controllers, *self.spec.sensors} - self.used
        return fold.digest(self.folds, ["" if block in aside else block for block in self.wiring.signals.output_blocks])

    def scores(self) -> dict[str, Scores]:
        """Return the score of every diagnoser that chooses between hypotheses; none on a record without labels."""
        return scores(self.spec, self.wiring)

    # -- time

    def advance(self, n: int) -> Rows:
        """Run up to ``n`` ticks (at most ``CHUNK``); fewer when the board trips.

        Pending commands take effect at the edges of the ticks they wait for, whatever the chunks. A block that has lost
        its state trips the board at the next whole multiple of `EVERY` ticks.
        """
        first, idle = self.tick, self._advance(n, None)
        return Rows(first, done := self.tick - first, self._outputs[:done], self._taps[:done], idle)

    @property
    def keeps(self) -> bool:
        """Whether its ticks can go into a history without rows."""
        return self.compiled

    def advance_into(self, history: History, n: int) -> KeptTicks:
        """Advance a board that ``keeps`` in the same way, with the ticks in a history instead of rows."""
        first = self.tick
        self._advance(n, history)
        return KeptTicks(first, self.tick - first, history)

    def _advance(self, n: int, history: History | None) -> BoolArray:
        """Run ticks, and return the taps that stayed 0 throughout."""
        first, end = self.tick, self.tick + min(n, CHUNK, self._left())
        self.walk.join()
        idle = self.walk.idle
        while self.tick < end:
            self.apply_due()
            idle = idle & self.walk.idle
            if self.trip is not None:
                break
            for finding in self.observer.caution(self.spec, self.tick):
                self.note("board", **finding)
            upcoming = self.pending.next_tick
            stop = min(end, next_look(self.tick))
            stop = stop if upcoming is None else min(stop, upcoming)
            ran, why = self._run(stop - self.tick, self.tick - first, history)
            for finding in self._findings(ran, why, self.tick - first, history):
                self.note("board", **finding)
            self.used |= {*self.spec.driving.values(), self.spec.measuring}
            self.tick += ran
            if why in (program.TRIPPED, program.WATCHED):
                self.pending.meet(self.value, self.tick)
            if why == program.TRIPPED:
                self._trip(*changes.cause(self))
            elif self.lost is not None and self.tick % EVERY == 0:
                self._trip(f"the state of {self.lost.block} has not been finite since sample {self.lost.tick}")
        return idle

    def _left(self) -> int:
        """Return the ticks that the plant can play now; at the end of a record that does not grow the board trips."""
        left, has_ended = (CHUNK, False) if self.spec.record is None else playable(self.spec.record, self.tick)
        if has_ended and self.trip is None:
            self._trip("the record has ended")
        return left

    def _supply(self, n: int) -> None:
        """Give the plant the samples of the next ticks, where it is a record."""
        if self.spec.record is not None:
            supply(self.wiring.state_of("plant"), self.spec.plant.params, self.spec.record, self.tick, n)

    def _findings(self, ran: int, why: int, at: int, history: History | None) -> list[Finding]:
        """Return the findings in the ticks that have just run."""
        if history is None:
            rows = slice(at, at + ran)
            return self.observer.look(self.spec, self.tick, self._outputs[rows], self._taps[rows])
        if why == program.DONE:  # it stops behind each tick in which anything changes
            return []
        last = self.wiring.w[None, RESERVED:]
        taps, outputs = len(self.walk.idle), self._outputs.shape[1]
        return self.observer.look(self.spec, self.tick + ran - 1, last[:, :outputs], last[:, outputs : outputs + taps])

    def _run(self, n: int, at: int, history: History | None) -> tuple[int, int]:
        """Run ticks without a command between them; return how many ran, and why the loop stopped."""
        self._supply(n)
        wiring, before = self.wiring, (self.wiring.s.copy(), self.wiring.w.copy())
        rows = self._outputs[at:], self._taps[at:], self.folds
        ran, why = self._loop(n, self.tick, *rows) if history is None else self._keep(n, history)
        if not lost(wiring, self.spec):
            self.lost = None
            return ran, why
        # the same ticks once more, one by one, so that the first loss does not depend on slices
        wiring.s[:], wiring.w[:] = before
        row = np.empty((1, self._outputs.shape[1])), np.empty((1, self._taps.shape[1]))
        for tick in range(self.tick, self.tick + ran):
            self._loop(1, tick, *row, self.folds.copy())
            self._look(tick + 1)
        return ran, why

    def _keep(self, n: int, history: History) -> tuple[int, int]:
        """Run ticks into a history."""
        wiring, resting = self.wiring, history.begin(self.tick, self.walk.idle)
        arrays = self.walk.table, wiring.p, wiring.s, wiring.w, wiring.io, len(self.walk.idle), self.folds
        watches, followed = self._watches(), self.observer.followed
        rest: Any = *arrays, wiring.trip, watches, *followed, *history.rings, resting
        ran, why = kept.run(n, self.tick, self.dt_ms, *rest)
        history.end(ran)
        return ran, why

    def _loop(self, n: int, tick: int, outputs: FloatArray, taps: FloatArray, folds: Words) -> tuple[int, int]:
        wiring, watches = self.wiring, self._watches()
        arrays = self.walk.table, wiring.p, wiring.s, wiring.w, wiring.io, outputs, taps, folds
        arguments = n, tick, self.dt_ms, *arrays, wiring.trip, watches
        return program.run(*arguments) if self.compiled else program.run_uncompiled(self.walk.steps, *arguments)

    def _look(self, tick: int) -> None:
        """Note at a tick edge which block has lost its state, if it had not before."""
        block = lost(self.wiring, self.spec)
        self.lost = (self.lost or Lost(block, tick)) if block else None

    def _watches(self) -> FloatArray:
        return supervision.watched(self.spec, self.wiring, self.pending.watches(self.wiring.index))

    def link(self) -> None:
        """Take over a wiring that has changed."""
        self.walk.link(self.wiring, self.spec)

    def fuse(self) -> None:
        """From now on run each segment of a tick as one function if its code is loaded; no bit depends on it.

        ``unfused`` has the segments whose code is not loaded: until it is, their rows run one by one.
        """
        self.fuses = self.compiled
        self.walk.fuse(self.wiring)

    def renew(self) -> None:
        """Take the code of all steps that `core.kernel.renew` has loaded; at a tick edge, and no bit changes."""
        self.walk.forget()
        self.link()

    def _allocate(self) -> None:
        """Make room for the rows of a chunk; the signals of a board never change, so once is enough."""
        self._outputs = np.zeros((CHUNK, self.wiring.signals.outputs))
        self._taps = np.zeros((CHUNK, len(self.wiring.signals.taps)))

    # -- commands

    def apply(self, command: Command, actor: str = "scenario") -> LogEntry:
        """Let a command take effect at this tick edge, or wait for its moment if it names one.

        Raises
        ------
        InputError
            When the command is not allowed; nothing has changed then.
        """
        self.obey()
        moment = command.tick(self.dt_ms)
        if moment is not None and moment < self.tick:
            raise InputError(f"sample {moment} has passed, the board is at {self.tick}", "at_sample")
        condition = parse_condition(command.when, self.wiring.signals.names) if command.when is not None else None
        later = moment is not None and moment > self.tick
        if later or condition is not None:
            return self._wait(command, actor, moment if later else None, condition)
        return self._do(command, actor)

    def _wait(self, command: Command, actor: str, tick: int | None, condition: Condition | None) -> LogEntry:
        changes.check(self.spec, command)
        self.pending.add(PendingCommand(command, actor, tick, condition, self.tick))
        return self.note(actor, "scheduled", f"waiting: {words.describe(command, self.spec.library)}", command=command)

    def obey(self) -> None:
        """Carry out the request of the supervisor, before any command at this tick; a tripped board does nothing.

        It is a consequence of the samples, so it is no command that `save` or a track would repeat.
        """
        if not self.spec.supervisors or (requested := supervision.take_request(self.spec, self.wiring)) is None:
            return
        for command in requested.commands if self.trip is None else ():
            try:
                self._do(command, SUPERVISOR, requested.reason)
            except InputError as error:
                self.note(SUPERVISOR, "refused", f"{words.describe(command, self.spec.library)}: {error}")

    def apply_due(self) -> None:
        """Carry out the commands due at this tick, as the next advance would."""
        self.obey()
        for entry in self.pending.take_due(self.tick):
            try:
                self._do(entry.command, entry.actor)
            except InputError as error:
                text = f"{words.describe(entry.command, self.spec.library)}: {error}"
                self.note("board", "refused", text, command=entry.command)

    def _do(self, command: Command, actor: str, reason: str = "") -> LogEntry:
        """Carry out a command, or a consequence, which has a reason."""
        old, new = changes.carry_out(self, command)
        if reason:
            self.consequences.append(Consequence(self.tick, command, reason))
        else:
            self.done.append((self.tick, command))
        text = words.describe(command, self.spec.library) + (f": {reason}" if reason else "")
        return self.note(actor, command.kind, text, command=command.at(None), old=old, new=new)

    # -- log

    def note(
        self,
        actor: str,
        kind: str,
        text: str,
        *,
        command: Command | None = None,
        tick: int | None = None,
        old: Any = None,
        new: Any = None,
    ) -> LogEntry:
        """Write an entry of the log, at this tick unless another is named."""
        document = command.document() if command is not None else None
        return self.log.add(self.tick if tick is None else tick, actor, kind, text, document, old, new)

    def _trip(self, text: str, signal: str = "") -> None:
        value = self.value(signal) if signal else math.nan
        reason = text.format(signal=signal)
        self.trip = Trip(
            tick=self.tick,
            time_ms=self.tick * self.dt_ms,
            reason=reason,
            signal=signal,
            value=value if math.isfinite(value) else None,
        )
        changes.disengage(self)
        self.note("board", "tripped", f"tripped: {reason}", new=self.trip.model_dump())

    # -- copies

    def checkpoint(self) -> Checkpoint:
        """Return everything the board is at this tick edge."""
        kept = {name: copy.deepcopy(getattr(self, name)) for name in COPIED}
        shared = {name: getattr(self, name) for name in SHARED}
        lists = {"log": self.log.copy(), "done": list(self.done), "consequences": list(self.consequences)}
        return Checkpoint(self.tick, type(self), {**kept, **shared, **lists})

    @staticmethod
    def restore(checkpoint: Checkpoint) -> Board:
        """Return a board that continues from a checkpoint, bit for bit; restoring twice forks it."""
        board = checkpoint.kind.__new__(checkpoint.kind)
        for name, value in checkpoint.parts.items():
            setattr(board, name, copy.deepcopy(value) if name in COPIED else value)
        board._revive()
        return board

    def _revive(self) -> None:
        """Make the parts that copies do not share."""
        self.log, self.done, self.consequences = self.log.copy(), list(self.done), list(self.consequences)
        self.walk = Walk(self.wiring, compiled=self.compiled, fuses=self.fuses)
        self._allocate()
        self.link()

    def save(self) -> Document:
        """Return the bench as a scenario document: its start and the commands to it.

        Run headless it gives the same bits.
        """
        events = [command.at(tick).document() for tick, command in self.done] + [
            entry.event() for entry in self.pending.as_asked
        ]
        length = {"samples": self.tick} if self.tick else {}
        return {**copy.deepcopy(self.base), **length, "events": events}
