"""A board among boards that run abreast."""

from __future__ import annotations

from itertools import zip_longest

from core.board import changes
from core.board.board import Board
from core.board.commands import Command, HealFaults, Inject
from core.board.fold import Words
from core.board.instances import Instance
from core.board.log import Log, LogEntry
from core.board.pattern import numbers, unlike
from core.board.pending import PendingQueue
from core.board.program import P_OFFSET
from core.board.spec import Spec
from core.board.wiring import Wiring
from core.loop.score import Scores


class Lane(Board):
    """A board whose arrays are columns of the arrays of all boards; it keeps no log.

    A lane with the same waiting faults as an earlier lane follows it: the leader carries out the commands, and its
    followers take over the changes. They share all of its wiring but the numbers and parameters. ``specs`` holds the
    benches of the lane, each with its first tick; faults alone make no new one.

    Parameters
    ----------
    spec : Spec
        The bench.
    wiring : Wiring
        Its wiring; its arrays of numbers are columns of the arrays of all boards.
    folds : ndarray
        Its folds.
    pending : Queue
        The commands that wait.
    leader : Lane, optional
        The lane it follows.
    """

    def __init__(
        self, spec: Spec, wiring: Wiring, folds: Words, pending: PendingQueue, leader: Lane | None = None
    ) -> None:
        self.spec, self.wiring, self.folds, self.pending = spec, wiring, folds, pending
        self.base = spec.document
        self.compiled, self.tick, self.trip, self.lost = True, 0, None, None
        self.log, self.done, self.consequences, self.used = Log(), [], [], set()
        self.followers: list[Lane] = []
        self.specs: list[tuple[int, Spec]] = [(0, spec)]
        self._unlike: dict[tuple[int, str], set[str]] = {}
        self._scores: tuple[int, dict[str, Scores]] | None = None
        if leader is not None:
            leader.followers.append(self)
            self.done, self.used = leader.done, leader.used

    def scores(self) -> dict[str, Scores]:
        """Return the score of every diagnoser that chooses between hypotheses, read once at each tick."""
        if self._scores is None or self._scores[0] != self.tick:
            self._scores = self.tick, super().scores()
        return self._scores[1]

    def leads(self, pending: PendingQueue) -> bool:
        """Say whether another lane has the same waiting commands as this lane, all of them for faults."""
        return all(
            one is not None
            and other is not None
            and (one is other or (one.tick, one.command) == (other.tick, other.command))
            and isinstance(one.command, Inject | HealFaults)
            for one, other in zip_longest(self.pending, pending)
        )

    def link(self) -> None:
        """Leave it to all boards together."""

    def carry_out_due(self) -> None:
        """Carry out the commands due at this tick, here and in the lanes that follow."""
        before, done = self.wiring.instances, len(self.done)
        self.apply_due()
        if not all(isinstance(command, Inject | HealFaults) for _, command in self.done[done:]):
            if self.specs[-1][0] == self.tick:
                self.specs.pop()
            self.specs.append((self.tick, self.spec))
        now = self.wiring.instances
        changed = [row for row, instance in enumerate(now) if instance is not before[row] and instance != before[row]]
        for row in changed:
            self._hand_on(row, now[row])

    def tell_faults(self) -> None:
        """Tell the lanes that follow which faults there are at the end."""
        for lane in self.followers:
            lane.spec = lane.spec.with_faults(self.spec.faults)

    def rest(self) -> list[int]:
        """Return the rows that run, and put the others to rest, in the lanes that follow too."""
        before = self.wiring.resting
        running = self.wiring.rest(self.spec)
        for lane in self.followers if self.wiring.resting is not before else ():
            lane.wiring.put_to_rest(lane.spec, self.wiring.resting - before)
            lane.wiring.resting = self.wiring.resting
        return running

    def _hand_on(self, row: int, instance: Instance) -> None:
        """Give the followers the parameters of a row: the leader's, unless the facts they are made of differ."""
        place = instance.every, instance.axis
        context = self.spec.context(*place)
        own, _, read = numbers(instance, self.spec)
        start = int(self.wiring.table[row, P_OFFSET])
        part = slice(start, start + len(own))
        for lane in self.followers:
            if place not in lane._unlike:
                lane._unlike[place] = unlike(lane.spec.context(*place), context)
            is_shared = lane._unlike[place].isdisjoint(read)
            lane.wiring.instances[row] = instance
            lane.wiring.p[part] = own if is_shared else instance.packed(lane.spec.context(*place))

    def _do(self, command: Command, actor: str, reason: str = "") -> LogEntry | None:  # type: ignore[override]
        changes.carry_out(self, command)
        self.done.append((self.tick, command))
        return None

    def note(self, *_arguments: object, **_named: object) -> None:  # type: ignore[override]
        """Keep nothing."""
