"""Constraints of an environment: signals that should stay between two ends, as safe-control-gym has them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.block import BoolArray, FloatArray, IntArray
from core.errors import InputError, unknown
from scenarios.outside.episodes import Ranges, ends_of

NOTHING, PENALTY, END = "nothing", "penalty", "end"
ON_VIOLATION = (NOTHING, PENALTY, END)
"""Consequences of a violation."""


class Constraints:
    r"""Bounds of signals, :math:`g(x)=\max(x_{low}-x,\,x-x_{high})\le 0`, the largest over the ticks of a step.

    Parameters
    ----------
    bounds : mapping
        Signals, each with its two ends, in its own unit.
    signals : sequence of str
        The signals that the bench has.
    on_violation : str
        ``nothing``, ``penalty`` (taken off the reward), or ``end`` (the episode terminates).
    penalty : float
        How much a violated step costs.

    Raises
    ------
    InputError
        For a signal that there is not, a range without an order, or another consequence.
    """

    def __init__(self, bounds: Ranges, signals: Sequence[str], on_violation: str, penalty: float) -> None:
        for name in bounds:
            if name not in signals:
                raise unknown("signal", name, signals, "constraints")
        if on_violation not in ON_VIOLATION:
            raise unknown("consequence", on_violation, ON_VIOLATION, "on_violation")
        if penalty < 0.0:
            raise InputError(f"must not be negative, got {penalty}", "penalty")
        self.names = [*bounds]
        ends = [ends_of(bounds[name], f"constraints.{name}") for name in self.names]
        self._low, self._high = np.array(ends).reshape(-1, 2).T[:, None, :, None]
        self.ends = on_violation == END
        self.penalty = penalty if on_violation == PENALTY else 0.0

    def values(self, rows: FloatArray, counts: IntArray) -> FloatArray:
        """Return the values of the constraints, shape (boards, constraints); a board without a tick has none above 0.

        Parameters
        ----------
        rows : ndarray, shape (ticks, constraints, boards)
            The signals.
        counts : ndarray, shape (boards,)
            The ticks that count.
        """
        beyond = np.maximum(self._low - rows, rows - self._high)
        is_there = np.arange(len(rows))[:, None, None] < counts
        found: FloatArray = np.where(is_there, beyond, -np.inf).max(axis=0).T
        return np.where(counts[:, None] > 0, found, 0.0)

    @staticmethod
    def violated(values: FloatArray) -> BoolArray:
        """Say for each board whether it violates a constraint."""
        found: BoolArray = np.asarray((values > 0.0).any(axis=1))
        return found
