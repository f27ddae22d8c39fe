"""Beam stiffness."""

from __future__ import annotations

from typing import Any

from core.block import TICK, Equation, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at

STIFFNESS, ELASTICITY, SEVERITY = range(3)


def stiffness_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Multiply the stiffness along x, and with it that of every beam."""
    severity = severity_at(p, w[TICK])
    w[io[SEVERITY]] = severity
    if severity != 0.0:
        w[io[STIFFNESS]] *= 1.0 + severity
        w[io[ELASTICITY]] *= 1.0 + severity


class Stiffness(Fault):
    r"""Young's modulus of all beams and trusses, :math:`E\to E(1+s)`.

    The suspension is one film, so all of its stiffnesses go with it: along x, :math:`k\to k(1+s)`, sideways, in
    rotation and cubic. Pull-in by the bias moves by :math:`\sqrt{1+s}`.
    """

    title = "Beam stiffness"
    shows = "beams"
    changes = (
        "stiffness of the suspension along x in every plant, sideways and in rotation, and so pull-in, in the planar "
        "plant; resonance and displacement at rest both move"
    )
    suggested = 0.05
    inputs = channels("stiffness_scale", "elasticity_scale")
    outputs = (Port("severity", "1", "added stiffness, share of nominal"),)
    equations = (Equation("effect", r"k\to k\,(1+s),\quad k_y\to k_y(1+s),\quad k_\theta\to k_\theta(1+s)", "5.2.4"),)

    class Params(FaultParams):
        """Severity is a share of the nominal stiffness."""

        severity: float = parameter(0.0, "added stiffness, share of nominal", "1", gt=-0.95, le=20)

    step = stiffness_step
