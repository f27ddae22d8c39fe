"""Beam stiffness."""

from __future__ import annotations

from core.block import Equation, Port, parameter
from core.faults.fault import Fault, FaultParams, channel, scale_step


class Stiffness(Fault):
    r"""Stiffness of all beams, :math:`k\to k(1+s)`."""

    title = "Beam stiffness"
    shows = "beams"
    changes = "stiffness of the suspension; resonance and displacement at rest both move"
    suggested = 0.05
    inputs = channel("stiffness_scale")
    outputs = (Port("severity", "1", "added stiffness, share of nominal"),)
    equations = (Equation("effect", r"k\to k\,(1+s)", "5.2.4"),)

    class Params(FaultParams):
        """Severity is a share of the nominal stiffness."""

        severity: float = parameter(0.0, "added stiffness, share of nominal", "1", gt=-0.95, le=20)

    step = scale_step
