"""Broken truss."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Context, Equation, parameter
from core.device.frame import Damage
from core.device.geometry import drawn
from core.faults.fault import FaultParams, severity
from core.faults.structure import Bending, FaultEffects, StructureFault, effects

EXTENTS = {
    "end": (Damage(lost_ends=(2,)), Bending(10.0 / 9.4, 21.6 / 39.7, 0.0, 80.0, -3.5e10)),
    "whole": (Damage(lost_ends=(0, 1, 2)), Bending(1.0, 41.0 / 39.7, 0.0, -35.0, -1.7e10)),
}


class BrokenTruss(StructureFault):
    r"""A truss broken off at one end, or the whole truss of one side lost.

    One end leaves 0.83 of the stiffness (5/6 for stiff trusses), the whole truss 0.49. The displacement grows, by 1.205
    for one end, and the effort to follow a model falls by as much; the text's effort rises by 20 %.
    """

    title = "Broken truss"
    group, place = "Suspension", 8
    shows = "trusses"
    changes = (
        "stiffness of the suspension in every plant; the rotation and a pull-in at half the voltage in the planar "
        "plant only"
    )
    suggested = 1.0
    equations = (
        Equation(
            "stiffness",
            r"k\to k\,[1+s(r-1)],\quad r\approx5/6\ \text{(one end)},\ 1/2\ \text{(whole)}",
            "3.1.3.2, case 2",
            printed=r"\text{efforts about 20\,\% higher}",
            why="a suspension that has lost a part is softer, so the effort falls; 1/0.83 = 1.205 is the "
            "displacement at the same voltage",
        ),
    )

    class Params(FaultParams):
        """Severity 1 is a clean break."""

        severity: float = parameter(0.0, "how far the truss is broken", "1", ge=0, le=1)
        extent: Literal["end", "whole"] = parameter("end", "one end of a truss, or the whole truss of one side")

    class Ports(StructureFault.Ports):
        """The suspension."""

        severity: float = severity("1", "how far the truss is broken")

    @classmethod
    def whole(cls, params: Any, context: Context) -> FaultEffects:
        """Return a share of the effects of a clean break."""
        return effects(drawn(context), *EXTENTS[params.extent]).scaled(params.severity)
