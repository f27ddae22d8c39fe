"""Blocks that are computed outside of a board: their inputs at a sample, and the place of their answers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from core.block import FloatArray
from core.board.wiring import Wiring
from core.errors import InputError, short
from core.ports import TIME_MS


class Sample(NamedTuple):
    """The values that a controller may read at a sample, and nothing of the truth.

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
        Whether the controller drives. In shadow it should be ready to continue from ``applied``.
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


class Observation(NamedTuple):
    """The values that a diagnoser or an identifier may read at a sample, and nothing of the truth.

    Parameters
    ----------
    begins : bool
        Whether to begin anew: at the first sample, after a reset.
    tick : int
        The sample.
    time_ms, dt_ms : float
        Device time, and the time to the next sample.
    measured : float
        Measured displacement, um.
    applied, middle, end : float
        Voltage applied at the start, in the middle and at the end of the tick that ends now, V; all equal when the
        drive holds it.
    """

    begins: bool
    tick: int
    time_ms: float
    dt_ms: float
    measured: float
    applied: float
    middle: float
    end: float


Law = Callable[[Sample], float]
"""A controller: a voltage for every sample, V."""
Conclusion = Callable[[Observation], Iterable[float]]
"""A diagnoser: the probability of each hypothesis. An identifier: mass, stiffness and damping over nominal."""

CLOCK = 4
"""Fields of a sample before its signals."""


class OutsideBlock:
    """A block whose numbers come from outside: it is asked before its step, which passes the answer on.

    Parameters
    ----------
    key : str
        The block on the board.
    kind : type
        The record it may read: `Sample`, or `Observation`.
    ask : callable
        The function that answers.
    numbers : int
        How many numbers an answer has.
    meaning : str
        Their meaning, for the line that refuses another answer.
    """

    def __init__(self, key: str, kind: type[Any], ask: Callable[[Any], Any], numbers: int, meaning: str) -> None:
        self.key, self.begins = key, True
        self._kind, self._ask, self._numbers, self._meaning = kind, ask, numbers, meaning

    def link(self, wiring: Wiring, running: list[int], dt_ms: float) -> None:
        """Find its row, the places of its inputs and the place of its answer."""
        row = wiring.row(self.key)
        instance = wiring.instances[row]
        places = dict(zip((port.name for port in instance.block.inputs), wiring.ports(row).tolist(), strict=False))
        self.cut = running.index(row)
        self.every, self._dt_ms = instance.every, dt_ms * instance.every
        self._places = [places[name] for name in self._kind._fields[CLOCK:]]
        self.answered = wiring.state_of(self.key)

    def sample(self, tick: int, w: FloatArray) -> Any:
        """Return the sample or the observation of a tick."""
        values = w[self._places].tolist()
        if self._kind is Sample:
            values[-1] = values[-1] != 0.0
        return self._kind(self.begins, tick, float(w[TIME_MS]), self._dt_ms, *values)

    def ask(self, sample: Any) -> None:
        """Take the answer to a sample.

        Raises
        ------
        InputError
            When it is not as many numbers as it should be.
        """
        answer = self._ask(sample)
        try:
            numbers = [float(one) for one in (answer if self._kind is Observation else (answer,))]
        except (TypeError, ValueError):
            numbers = []
        if len(numbers) != self._numbers:
            text = f"must answer with {self._meaning}; at sample {sample.tick} it was {short(answer)}"
            raise InputError(text, self.key)
        self.answered[: self._numbers] = numbers
        self.begins = False
