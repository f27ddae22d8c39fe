"""A board whose controller is computed outside: asked at every sample, between what is measured and what is held."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from core.board import program
from core.board.board import Board, Checkpoint
from core.board.commands import Command, ResetTrip, Switch
from core.board.log import LogEntry
from core.board.parse import changed
from core.board.spec import Spec
from core.control.external import External
from core.errors import InputError, short
from core.ports import TICK, TIME_MS


class Sample(NamedTuple):
    """What a controller may read at a sample, and nothing of the truth.

    Parameters
    ----------
    begins : bool
        Whether to begin anew: at the first sample, after a reset, at a cold start.
    tick : int
        The sample.
    time_ms, dt_ms : float
        Device time, and the time to the next sample.
    reference : float
        Reference voltage, V.
    model : float
        Where the shuttle should be, um.
    measured : float
        Measured displacement, um.
    applied : float
        Voltage applied over the sample that ends now, V.
    engaged : bool
        Whether the controller drives. In shadow it should be ready to go on from ``applied``.
    """

    begins: bool
    tick: int
    time_ms: float
    dt_ms: float
    reference: float
    model: float
    measured: float
    applied: float
    engaged: bool


Law = Callable[[Sample], float]
"""A controller: a voltage for every sample, V."""


class Hosted(Board):
    """A board with a controller from outside, which drives from the first sample unless an event switches.

    A tick is cut in two: the steps up to the controller, then the law, then the rest. So the voltage that follows from
    a measurement is held over the very next sample, as that of a law of the library.

    Parameters
    ----------
    bench : Spec
        The bench; its own controllers run in shadow.
    law : callable
        The controller.
    compiled : bool
        Run compiled blocks.

    Raises
    ------
    InputError
        When the plant has axes, or the drive is analogue.
    """

    def __init__(self, bench: Spec, law: Law, *, compiled: bool = True) -> None:
        self._law, self._begins, self._begun = law, True, -1
        name = External.name
        super().__init__(changed(bench, {"controller.kind": name, f"controllers.{name}": {}}), compiled=compiled)

    def link(self) -> None:
        """Find the row of the law and what it reads, besides what every board does."""
        super().link()
        row = self.wiring.row(External.name)
        self._cut = self._running.index(row)
        places = dict(zip((port.name for port in External.inputs), self.wiring.ports(row).tolist(), strict=False))
        self._places = [places[name] for name in ("reference", "model", "measured", "applied", "engaged")]
        self._state = self.wiring.state_of(External.name)

    def sample(self) -> Sample | None:
        """Begin the next tick and return what the controller may read; None once the board has tripped.

        `advance` goes on from there with the answer of the law.
        """
        self.apply_due()
        return None if self.trip is not None else self._begin(self.tick)

    def checkpoint(self) -> Checkpoint:
        """Refuse: what runs outside cannot be copied."""
        raise InputError("cannot be copied: its controller runs outside of it", "board")

    def _do(self, command: Command, actor: str) -> LogEntry:
        ran_away = not math.isfinite(self._state[0])
        entry = super()._do(command, actor)
        if isinstance(command, Switch) and command.switch == External.name:
            self._begins |= command.cold or ran_away
        self._begins |= isinstance(command, ResetTrip)
        return entry

    def _begin(self, tick: int) -> Sample:
        """Run the steps before the controller, once a tick."""
        wiring = self.wiring
        if self._begun != tick:
            self._begun, table = tick, self._table[: self._cut]
            if self.compiled:
                program.begin(table, tick, self.dt_ms, wiring.p, wiring.s, wiring.w, wiring.io)
            else:
                self._begin_uncompiled(tick)
        reference, model, measured, applied, engaged = wiring.w[self._places].tolist()
        time_ms = float(wiring.w[TIME_MS])
        return Sample(self._begins, tick, time_ms, self.dt_ms, reference, model, measured, applied, engaged != 0.0)

    @np.errstate(all="ignore")
    def _begin_uncompiled(self, tick: int) -> None:
        self.wiring.w[TICK], self.wiring.w[TIME_MS] = tick, tick * self.dt_ms
        for step, row in zip(self._steps[: self._cut], self._table, strict=False):
            if tick % row[program.EVERY] == 0:
                step()

    def _ask(self, sample: Sample) -> None:
        """Take the answer of the law; a number that is not finite trips the board at this tick."""
        answer: Any = self._law(sample)
        try:
            self._state[0] = float(answer)
        except (TypeError, ValueError):
            text = f"must answer with one number, the voltage; at sample {sample.tick} it was {short(answer)}"
            raise InputError(text, External.name) from None
        self._begins = False

    def _run(self, n: int, at: int) -> tuple[int, int]:
        wiring, cut = self.wiring, self._cut
        watches = self.pending.watches(wiring.index)
        for i in range(n):
            tick = self.tick + i
            self._ask(self._begin(tick))
            rest: Any = (
                1,
                tick,
                self.dt_ms,
                self._table[cut:],
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
            _, why = program.run(*rest) if self.compiled else program.run_uncompiled(self._steps[cut:], *rest)
            if why != program.DONE:
                return i + 1, why
        return n, program.DONE
