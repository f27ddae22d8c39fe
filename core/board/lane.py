"""A board among boards that run abreast."""

from __future__ import annotations

from collections.abc import Sequence

from core.block import Context
from core.board import changes
from core.board.board import Board
from core.board.commands import Command, HealFaults, Inject
from core.board.course import ChangedRow, Course, CourseStep
from core.board.facts import numbers, unlike
from core.board.fold import Words
from core.board.log import Log, LogEntry
from core.board.pattern import Uneven
from core.board.pending import PendingQueue
from core.board.program import EVERY, P_OFFSET
from core.board.spec import Spec
from core.board.wiring import Wiring
from core.loop.score import Scores


class Lane(Board):
    """A board whose arrays are columns of the arrays of all boards; it keeps no log.

    A lane with the same waiting faults as an earlier lane follows it: the leader carries out the commands, and its
    followers take over the changes. They share all of its wiring but the numbers and parameters. A leader takes over
    the changes of earlier boards with the same waiting faults in the same way. ``specs`` holds the benches of the lane,
    each with its first tick; faults alone make no new one.

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
    course : Course
        The changes that the commands make, as far as they are known.
    leader : Lane, optional
        The lane it follows.
    """

    def __init__(
        self,
        spec: Spec,
        wiring: Wiring,
        folds: Words,
        pending: PendingQueue,
        course: Course,
        leader: Lane | None = None,
    ) -> None:
        self.spec, self.wiring, self.folds, self.pending = spec, wiring, folds, pending
        self.base = spec.document
        self.compiled, self.tick, self.trip, self.lost = True, 0, None, None
        self.log, self.done, self.consequences, self.used = Log(), [], [], set()
        self.followers: list[Lane] = []
        self.course = course
        self.step: CourseStep | None = None
        """The changes of the commands that were carried out last."""
        self.specs: list[tuple[int, Spec]] = [(0, spec)]
        self._unlike: dict[int, tuple[Context, set[str]]] = {}
        self._scores: tuple[int, dict[str, Scores]] | None = None
        if leader is not None:
            leader.followers.append(self)
            self.done, self.used = leader.done, leader.used

    def scores(self) -> dict[str, Scores]:
        """Return the score of every diagnoser that chooses between hypotheses, read once at each tick."""
        if self._scores is None or self._scores[0] != self.tick:
            self._scores = self.tick, super().scores()
        return self._scores[1]

    def link(self) -> None:
        """Leave it to all boards together."""

    def carry_out_due(self) -> tuple[CourseStep, Sequence[Lane]]:
        """Carry out the commands due at this tick; return the changes, and the lanes that are to take them over."""
        step = self.step = self.course.get(self.tick)
        if step is None:
            self.step = self._carry_out()
            return self.step, self.followers
        self.pending.take_due(self.tick)
        self.spec = self.spec.with_faults(step.faults)
        self.done += step.commands
        for row in step.rows:
            self._take_turns(row)
        return step, [self, *self.followers]

    def _carry_out(self) -> CourseStep:
        """Carry out the commands due here; note the changes, if all commands are for faults and none is refused.

        Raises
        ------
        Uneven
            When a block comes or goes.
        """
        before, done, waiting = self.wiring.instances, len(self.done), len([*self.pending])
        self.apply_due()
        commands, now = self.done[done:], self.wiring.instances
        if len(now) != len(before):
            raise Uneven("a block came or went")
        changed = [row for row, instance in enumerate(now) if instance is not before[row] and instance != before[row]]
        step = CourseStep(self.spec.faults, commands, [self._changed(row) for row in changed])
        if all(isinstance(command, Inject | HealFaults) for _, command in commands):
            if len(commands) == waiting - len([*self.pending]):
                self.course[self.tick] = step
        else:
            if self.specs[-1][0] == self.tick:
                self.specs.pop()
            self.specs.append((self.tick, self.spec))
        return step

    def _changed(self, row: int) -> ChangedRow:
        """Return a row as it is now, and the facts its numbers are made of."""
        instance, wiring = self.wiring.instances[row], self.wiring
        own, _, read = numbers(instance, self.spec)
        read |= {"seed"} if instance.block.Packed.streams else set()
        every, context = int(wiring.table[row, EVERY]), self.spec.context(instance.every, instance.axis)
        return ChangedRow(row, instance, context, own, read, every, wiring.absent[row])

    def _take_turns(self, row: ChangedRow) -> None:
        """Let a row run as often as it does now, or not at all."""
        wiring = self.wiring
        if (wiring.table[row.number, EVERY], wiring.absent[row.number]) != (row.every, row.is_absent):
            wiring.table[row.number, EVERY], wiring.absent[row.number] = row.every, row.is_absent
            wiring.is_changed = True

    def shares(self, row: ChangedRow) -> bool:
        """Say whether the facts that the numbers of a row are made of are the facts of this bench."""
        context = self.spec.context(row.instance.every, row.instance.axis)
        if id(row.context) not in self._unlike:  # kept with its result, so that no other context gets its id
            self._unlike[id(row.context)] = row.context, unlike(context, row.context)
        return self._unlike[id(row.context)][1].isdisjoint(row.read)

    def pack(self, row: ChangedRow) -> None:
        """Make the parameters of a row anew from the facts of this bench."""
        instance, start = row.instance, int(self.wiring.table[row.number, P_OFFSET])
        packed = instance.packed(self.spec.context(instance.every, instance.axis))
        self.wiring.p[start : start + len(packed)] = packed

    def use(self) -> None:
        """Note the controllers and the sensor that are in use from now on."""
        self.used |= {*self.spec.driving.values(), self.spec.measuring}

    def tell_faults(self) -> None:
        """Tell the lanes that follow which faults there are at the end."""
        for lane in self.followers:
            lane.spec = lane.spec.with_faults(self.spec.faults)

    def rest(self) -> list[int]:
        """Return the rows that run, and put the others to rest, in the lanes that follow too."""
        wiring, step = self.wiring, self.step
        before, lanes = wiring.resting, self.followers
        if step is None or step.running is None or step.resting is None:
            running = wiring.rest(self.spec)
            if step is not None:
                step.running, step.resting = running, wiring.resting
        else:
            running, lanes = step.running, [self, *self.followers]
            wiring.is_changed, wiring.resting = False, step.resting
        for lane in lanes if wiring.resting is not before else ():
            lane.wiring.put_to_rest(lane.spec, wiring.resting - before)
            lane.wiring.resting = wiring.resting
        return running

    def _do(self, command: Command, actor: str, reason: str = "") -> LogEntry | None:  # type: ignore[override]
        changes.carry_out(self, command)
        self.done.append((self.tick, command))
        return None

    def note(self, *_arguments: object, **_named: object) -> None:  # type: ignore[override]
        """Keep nothing."""
