"""Debris."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.device.geometry import drawn
from core.device.lateral import lateral
from core.faults.fault import SEVERITY, Fault, FaultParams, channels, severity_at

STIFFER, DAMPER, TURNING, TURN, COMBS = range(5, 10)
COMB = {"right": 1.0, "left": 2.0}


def debris_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Add the spring of the particle, its drag, and a short when it conducts."""
    severity = severity_at(p, w[0])
    w[io[6]] = severity
    if severity != 0.0:
        share = severity / p[SEVERITY]
        w[io[0]] *= 1.0 + share * p[STIFFER]
        w[io[1]] *= 1.0 + share * p[DAMPER]
        w[io[2]] *= 1.0 + share * p[TURNING]
        w[io[3]] += share * p[TURN]
        if p[COMBS] != 0.0:
            w[io[4]] = float(int(w[io[4]]) | int(p[COMBS]))
            w[io[5]] += severity


class Debris(Fault):
    r"""A particle between fingers: a spring off the axis, with drag if wanted, and a short when it conducts.

    .. math:: U\to U+\tfrac12sk\,(x-y_d\theta)^2
    """

    title = "Debris"
    shows = "fingers"
    changes = (
        "stiffness and damping in every plant, and a short of one comb when it conducts; the rotation in the planar "
        "plant only"
    )
    suggested = 0.1
    inputs = channels("stiffness_scale", "damping_scale", "rotation_scale", "turn", "short", "other")
    outputs = (Port("severity", "1", "stiffness of the particle, share of nominal"),)
    equations = (Equation("effect", r"U\to U+\tfrac12sk\,(x-y_d\theta)^2", "3.1.3.2, 5.1.2"),)

    class Params(FaultParams):
        """Severity is the spring of the particle as a share of the nominal stiffness."""

        severity: float = parameter(0.0, "stiffness of the particle, share of nominal", "1", ge=0, le=20)
        damping: float = parameter(0.0, "drag of the particle, share of the nominal damping", "1", ge=0, le=20)
        place_um: float = parameter(200.0, "where along the comb, from the axis", "um", ge=-344, le=344)
        conductive: bool = parameter(False, "whether it shorts the comb it is in")
        comb: Literal["right", "left"] = parameter("right", "which comb it is in, seen with +x to the right")

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack severity, profile and effects: the spring as seen along x with the shuttle free to turn."""
        resists = 1e12 * lateral(drawn(context)).rotation_stiffness_nm
        spring = params.severity * context.device.stiffness
        turning = spring * params.place_um * params.place_um / resists
        own = [
            params.severity / (1.0 + turning),
            params.damping,
            turning,
            spring * params.place_um / resists / (1.0 + turning),
            COMB[params.comb] if params.conductive else 0.0,
        ]
        return np.array([*super().pack(params, context).tolist(), *own])

    step = debris_step
