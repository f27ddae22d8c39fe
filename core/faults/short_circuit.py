"""Short circuit."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at

COMBS = {"right": 1.0, "left": 2.0, "both": 3.0}


def short_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Short the comb."""
    severity = severity_at(p, w[0])
    w[io[2]] = severity
    if severity != 0.0:
        w[io[0]] = float(int(w[io[0]]) | int(p[5]))
        w[io[1]] += severity


class ShortCircuit(Fault):
    r"""Stator and shuttle on one potential: no voltage across that comb, the other one pulls alone.

    A failure, not a fault (5.1.2): the short stays after the fault is healed, until the board is reset.
    """

    title = "Short circuit"
    shows = "fingers"
    changes = "force of one comb or of both, in every plant, until the board is reset; the board stops"
    suggested = 1.0
    inputs = channels("short", "other")
    outputs = (Port("severity", "1", "1 while the short is forced"),)
    equations = (Equation("effect", r"V_{b1}-v\to0\ \text{(at +x)},\quad V_{b2}-v\to0\ \text{(at -x)}", "5.1.2"),)

    class Params(FaultParams):
        """Any severity but 0 is a whole short."""

        severity: float = parameter(0.0, "1 for a short", "1", ge=0, le=1)
        comb: Literal["right", "left", "both"] = parameter("right", "which comb, seen with +x to the right")

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack severity, profile and comb."""
        return np.array([*super().pack(params, context).tolist(), COMBS[params.comb]])

    step = short_step
