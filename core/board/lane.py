"""A board among boards that run abreast."""

from __future__ import annotations

from itertools import zip_longest

from core.board import changes
from core.board.board import Board
from core.board.commands import Command, Heal, Inject
from core.board.fold import Words
from core.board.instances import Instance
from core.board.log import Log, LogEntry
from core.board.pattern import is_same_but_seed
from core.board.pending import Queue
from core.board.spec import Spec
from core.board.wiring import Wiring


class Lane(Board):
    """A board whose arrays are columns of those of all; it keeps no log.

    A lane that differs from an earlier one by the seed alone follows it: the leader carries out the commands, and its
    followers take over what they change. They share all of its wiring but the numbers. ``specs`` are the benches it has
    been, each with the tick from which on, but for faults.

    Parameters
    ----------
    spec : Spec
        The bench.
    wiring : Wiring
        Its wiring, the arrays of numbers columns of those of all.
    folds : ndarray
        Its folds.
    pending : Queue
        The commands that wait.
    leader : Lane, optional
        The lane it follows.
    """

    def __init__(self, spec: Spec, wiring: Wiring, folds: Words, pending: Queue, leader: Lane | None = None) -> None:
        self.spec, self.wiring, self.folds, self.pending = spec, wiring, folds, pending
        self.base = spec.document
        self.compiled, self.tick, self.trip = True, 0, None
        self.log, self.done, self.used = Log(), [], set()
        self.followers: list[Lane] = []
        self.specs: list[tuple[int, Spec]] = [(0, spec)]
        if leader is not None:
            leader.followers.append(self)
            self.done, self.used, self.specs = leader.done, leader.used, leader.specs

    def leads(self, spec: Spec, pending: Queue) -> bool:
        """Say whether a bench and its commands are those of this lane but for the seed, and are faults alone."""
        return is_same_but_seed(self.spec, spec) and all(
            one is not None
            and other is not None
            and (one.tick, one.command) == (other.tick, other.command)
            and isinstance(one.command, Inject | Heal)
            for one, other in zip_longest(self.pending, pending)
        )

    def link(self) -> None:
        """Leave it to all boards together."""

    def carry_out_due(self) -> None:
        """Carry out what waits for this tick, here and in the lanes that follow."""
        before, done = self.wiring.instances, len(self.done)
        self.apply_due()
        if not all(isinstance(command, Inject | Heal) for _, command in self.done[done:]):
            if self.specs[-1][0] == self.tick:
                self.specs.pop()
            self.specs.append((self.tick, self.spec))
        now = self.wiring.instances
        changed = [row for row, instance in enumerate(now) if instance is not before[row] and instance != before[row]]
        for lane in self.followers:
            lane.spec = lane.spec.with_faults(self.spec.faults)
            lane.wiring.instances = now
        for row in changed:
            self._hand_on(row, now[row])

    def rest(self) -> list[int]:
        """Return the rows that run, and put the others to rest, in the lanes that follow too."""
        before = self.wiring.resting
        running = self.wiring.rest(self.spec)
        for lane in self.followers if self.wiring.resting is not before else ():
            lane.wiring.put_to_rest(lane.spec, self.wiring.resting - before)
            lane.wiring.resting = self.wiring.resting
        return running

    def _hand_on(self, row: int, instance: Instance) -> None:
        """Give the followers the parameters of a row: the same for all of them unless the seed has a say."""
        numbers, is_shared = self.wiring.packed(row), False
        for lane in self.followers:
            packed = lane.wiring.packed(row)
            packed[:] = numbers if is_shared else instance.packed(lane.spec)
            is_shared = is_shared or packed.tobytes() == numbers.tobytes()

    def _do(self, command: Command, actor: str) -> LogEntry | None:  # type: ignore[override]
        changes.carry_out(self, command)
        self.done.append((self.tick, command))
        return None

    def note(self, *_arguments: object, **_named: object) -> None:  # type: ignore[override]
        """Keep nothing."""
