"""A diagnoser that is computed outside of the board."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Context, Equation
from core.diagnose.judge import Judge
from core.diagnose.lanes import LANE
from core.record import Record, Vector, vector


class ExternalDiagnoser(Judge):
    r"""The probabilities come from outside, :math:`P_i=f(y_i,u_{i-1},\dots)`: from a function.

    It is called once the sample has been measured, as every other diagnoser. `core.board.hosted` calls it; any other
    board has no program to call.
    """

    title = "External"
    apart = True
    equations = (Equation("law", r"P_i=f(y_i,u_{i-1})"),)

    class State(Record):
        """The probabilities that were answered; no numbers before the first, and where the answer is none."""

        answered: Vector = vector(LANE)

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Nothing has been answered yet."""
        return cls.State(np.full(LANE, np.nan))

    @staticmethod
    def step(p: Judge.Packed, s: State, x: Judge.Ports) -> None:
        """Pass on the answer."""
        for k in range(int(p.count)):
            x.probability[k] = s.answered[k]
