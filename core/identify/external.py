"""An identifier that is computed outside of the board."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import BlockParams, Context, Equation
from core.identify.estimator import Estimator
from core.identify.identifier import PHYSICAL
from core.record import Record, Vector, vector


class ExternalIdentifier(Estimator):
    r"""The estimate comes from outside, :math:`\hat\theta_i=f(y_i,u_{i-1},\dots)`: from a function.

    It is called once the sample has been measured, as every other identifier. `core.board.hosted` calls it; any other
    board has no program to call.
    """

    title = "External"
    apart = True
    equations = (Equation("law", r"\hat\theta_i=f(y_i,u_{i-1})"),)

    class Params(BlockParams):
        """Its law is outside."""

    class State(Record):
        """Mass, stiffness and damping over nominal that were answered; no numbers where there is no answer."""

        answered: Vector = vector(len(PHYSICAL))

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Nothing has been answered yet."""
        return cls.State(np.full(len(PHYSICAL), np.nan))

    @staticmethod
    def step(p: Record, s: State, x: Estimator.Ports) -> None:
        """Pass on the answer."""
        for k in range(3):
            x.estimate[k] = s.answered[k]
