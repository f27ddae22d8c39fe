"""Beam stiffness."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record


class Stiffness(Fault):
    r"""Young's modulus of all beams and trusses, :math:`E\to E(1+s)`.

    The suspension is one film, so all of its stiffnesses change with it: along x, :math:`k\to k(1+s)`, sideways, in
    rotation and cubic. Pull-in by the bias moves by :math:`\sqrt{1+s}`.
    """

    title = "Beam stiffness"
    group, place = "The usual", 2
    shows = "beams"
    changes = (
        "stiffness of the suspension along x in every plant, sideways and in rotation, and so pull-in, in the planar "
        "plant; resonance and static displacement both move"
    )
    suggested = 0.05
    axes = None
    equations = (Equation("effect", r"k\to k\,(1+s),\quad k_y\to k_y(1+s),\quad k_\theta\to k_\theta(1+s)", "5.2.4"),)

    class Params(FaultParams):
        """Severity is a share of the nominal stiffness."""

        severity: float = parameter(0.0, "added stiffness, share of nominal", "1", gt=-0.95, le=20)

    class Ports(BlockPorts):
        """The stiffness along x, and the stiffness of every beam."""

        stiffness_scale: float = effect("stiffness_scale")
        elasticity_scale: float = effect("elasticity_scale")
        severity: float = severity("1", "added stiffness, share of nominal")

    @staticmethod
    def step(p: PackedFault, s: Record, x: Ports) -> None:
        """Multiply the stiffness along x and the stiffness of every beam."""
        now = severity_now(p, x.tick)
        x.severity = now
        if now != 0.0:
            x.stiffness_scale *= 1.0 + now
            x.elasticity_scale *= 1.0 + now
