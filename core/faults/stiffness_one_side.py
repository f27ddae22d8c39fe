"""Beam stiffness of one side."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, parameter
from core.device.frame import Damage
from core.device.geometry import drawn
from core.faults.fault import FaultParams, severity
from core.faults.structure import Bending, FaultEffects, StructureFault, effects


class StiffnessOneSide(StructureFault):
    r"""Young's modulus of beams and truss of the side at +y: :math:`k\to k(1+s/2)`, and a rotation with the travel.

    The stiffnesses sideways and in rotation belong to the frame of beams with one side stiffer.
    """

    title = "Beam stiffness, one side"
    group, place = "Suspension", 4
    shows = "beams"
    changes = (
        "stiffness of the suspension, by half the severity, in every plant; stiffness sideways and in rotation, and a "
        "rotation with the travel, in the planar plant only"
    )
    suggested = 0.1
    equations = (Equation("effect", r"k_{s,1}\to k_{s,1}(1+s),\quad k=k_{s,1}+k_{s,2}", "1.3.1, 3.1.3.2"),)

    class Params(FaultParams):
        """Severity is a share of the nominal stiffness of the side at +y."""

        severity: float = parameter(0.0, "added stiffness of one side, share of nominal", "1", gt=-0.95, le=20)

    class Ports(StructureFault.Ports):
        """The suspension."""

        severity: float = severity("1", "added stiffness of one side, share of nominal")

    @classmethod
    def whole(cls, params: Any, context: Context) -> FaultEffects:
        """Return the effects of a side with this stiffness."""
        whole = effects(drawn(context), Damage(side_scale=1.0 + params.severity), Bending())
        whole.stiffness = 0.5 * params.severity
        return whole
