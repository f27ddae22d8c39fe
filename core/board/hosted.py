"""A board with parts that are computed outside: asked at every sample, between the measurement and the held voltage."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from core.board import program
from core.board.board import Board, Checkpoint
from core.board.commands import Command, ResetTrip, Switch
from core.board.document import Document
from core.board.history import History
from core.board.log import LogEntry
from core.board.outside import Conclusion, Law, Observation, OutsideBlock, Sample
from core.board.parse import changed
from core.board.spec import Spec
from core.control.external import ExternalController
from core.diagnose.hypothesis import hypotheses_of, names_of
from core.errors import InputError
from core.identify.identifier import PHYSICAL
from core.ports import TICK, TIME_MS

OF_HYPOTHESES = "the probability of each hypothesis"
NOTHING: Mapping[str, Conclusion] = {}


class Hosted(Board):
    """A board with a controller, diagnosers or identifiers from outside.

    A tick is cut before each of them: the steps up to there, then its answer, then the rest. So a voltage that follows
    from a measurement is held over the very next sample, as with a law of the library.

    Parameters
    ----------
    bench : Spec
        The bench; its own controllers run in shadow of one from outside.
    law : callable, optional
        A controller, which drives from the first sample unless an event switches.
    diagnosers : mapping, optional
        Diagnosers by their ids. A diagnoser of the bench with this id is replaced and leaves its hypotheses; others
        have the six of 5.2.4.
    identifiers : mapping, optional
        Identifiers by their ids; an identifier of the bench with this id is replaced.
    compiled : bool
        Run compiled blocks.

    Raises
    ------
    InputError
        When the plant has axes; for a law when the drive is analogue.
    """

    def __init__(
        self,
        bench: Spec,
        law: Law | None = None,
        *,
        diagnosers: Mapping[str, Conclusion] = NOTHING,
        identifiers: Mapping[str, Conclusion] = NOTHING,
        compiled: bool = True,
    ) -> None:
        values: Document = (
            {"controller.kind": ExternalController.name, f"controllers.{ExternalController.name}": {}} if law else {}
        )
        for key, given in (("diagnosers", diagnosers), ("identifiers", identifiers)):
            if given:
                values[key] = {**bench.document.get(key, {}), **{name: _table(bench, key, name) for name in given}}
        spec, self._asked = changed(bench, values), list[OutsideBlock]()
        for name, ask in identifiers.items():
            self._asked.append(
                OutsideBlock(name, Observation, ask, len(PHYSICAL), f"{', '.join(PHYSICAL)} over nominal")
            )
        for name, ask in diagnosers.items():
            count = len(names_of(spec.diagnosers[name].params))
            self._asked.append(OutsideBlock(name, Observation, ask, count, f"{count} numbers, {OF_HYPOTHESES}"))
        self._law = OutsideBlock(ExternalController.name, Sample, law, 1, "one number, the voltage") if law else None
        self._asked += [self._law] if self._law else []
        self._begun = -1
        super().__init__(spec, compiled=compiled)

    def link(self) -> None:
        """Link the board, then find the rows of the blocks from outside and their inputs."""
        super().link()
        for one in self._asked:
            one.link(self.wiring, self.walk.running, self.dt_ms)
        self._asked.sort(key=lambda one: one.cut)
        self._cut = self._asked[-1].cut

    @property
    def keeps(self) -> bool:
        """Its ticks are cut into parts, and have rows."""
        return False

    def fuse(self) -> None:
        """Run all rows one by one as before: a tick is cut before each block from outside."""

    def sample(self) -> Sample | None:
        """Begin the next tick and return the sample for the controller; None once the board has tripped.

        `advance` continues from there with the answer of the law.
        """
        assert self._law is not None
        self.apply_due()
        if self.trip is not None:
            return None
        self._begin(self.tick)
        sample: Sample = self._law.sample(self.tick, self.wiring.w)
        return sample

    def checkpoint(self) -> Checkpoint:
        """Refuse: a part that runs outside cannot be copied."""
        raise InputError("cannot be copied: part of it runs outside", "board")

    def _do(self, command: Command, actor: str, reason: str = "") -> LogEntry:
        law = self._law
        ran_away = law is not None and not math.isfinite(law.answered[0])
        entry = super()._do(command, actor, reason)
        if law is not None and isinstance(command, Switch) and command.switch == law.key:
            law.begins |= command.cold or ran_away
        if isinstance(command, ResetTrip):
            for one in self._asked:
                one.begins = True
        return entry

    def _begin(self, tick: int) -> None:
        """Run the steps before the last that is computed outside, once a tick; those before it are asked on the way."""
        if self._begun == tick:
            return
        self._begun, first = tick, 0
        self._supply(1)
        for one in self._asked:
            self._walk(first, one.cut, tick)
            first = one.cut
            if one is not self._asked[-1]:
                self._ask(one, tick)

    def _ask(self, one: OutsideBlock, tick: int) -> None:
        """Ask for a row whose turn it is; a voltage that is not finite trips the board at this tick."""
        if tick % one.every == 0:
            one.ask(one.sample(tick, self.wiring.w))

    def _walk(self, first: int, end: int, tick: int) -> None:
        """Run some rows of a tick."""
        wiring = self.wiring
        if self.compiled:
            rows = self.walk.table[first:end]
            program.begin(rows, tick, self.dt_ms, wiring.p, wiring.s, wiring.w, wiring.io)
        else:
            self._walk_uncompiled(first, end, tick)

    @np.errstate(all="ignore")
    def _walk_uncompiled(self, first: int, end: int, tick: int) -> None:
        self.wiring.w[TICK], self.wiring.w[TIME_MS] = tick, tick * self.dt_ms
        for step, row in zip(self.walk.steps[first:end], self.walk.table[first:end], strict=True):
            if tick % row[program.EVERY] == 0:
                step()

    def _run(self, n: int, at: int, history: History | None) -> tuple[int, int]:
        wiring, cut = self.wiring, self._cut
        watches = self._watches()
        for i in range(n):
            tick = self.tick + i
            self._begin(tick)
            self._ask(self._asked[-1], tick)
            rest: Any = (
                1,
                tick,
                self.dt_ms,
                self.walk.table[cut:],
                wiring.p,
                wiring.s,
                wiring.w,
                wiring.io,
                self._outputs[at + i :],
                self._taps[at + i :],
                self.folds,
                wiring.trip,
                watches,
            )
            _, why = program.run(*rest) if self.compiled else program.run_uncompiled(self.walk.steps[cut:], *rest)
            self._look(tick + 1)
            if why != program.DONE:
                return i + 1, why
        return n, program.DONE


def _table(bench: Spec, key: str, name: str) -> Document:
    """Return the table of a block from outside, with interval and hypotheses of the bench's block of the same name."""
    section = getattr(bench, key).get(name)
    if section is None:
        return {"kind": ExternalController.name}
    hypotheses = [one.model_dump(exclude_defaults=True) for one in hypotheses_of(section.params)]
    return {
        "kind": ExternalController.name,
        "every": section.every,
        **({"hypotheses": hypotheses} if hypotheses and key == "diagnosers" else {}),
    }
