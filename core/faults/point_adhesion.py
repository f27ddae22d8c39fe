"""Point adhesion."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Context, Equation, parameter
from core.device.frame import Damage
from core.device.geometry import Geometry, drawn
from core.faults.fault import FaultParams, severity
from core.faults.structure import Bending, FaultEffects, StructureFault, effects, linear

FITTED = Damage(adhesion=("inner", 0.75))
BENDING = Bending(15.6 / 9.4, 37.8 / 39.7, 1.0e8, 1089.0, 1.18e11)


class PointAdhesion(StructureFault):
    r"""A point of one beam held to the ground, as a particle or a printed anchor does it.

    The stiffness rises by 1.46 at three quarters of an inner beam (the text's +46 % of effort) and at most by 1.5 there
    (36EI over 24EI); on an outer beam by 2.2 at three quarters, 5.0 at the middle, 19 at 0.3 and 461 at 0.1, where the
    rest of the beam holds the shuttle like a stub. The shuttle turns by about 30 rad per m of travel: the far end
    moves 1.01 times as far as the centre. The text's E = 2 treats the adhesion as a rigid pivot.
    """

    title = "Point adhesion"
    group, place = "Suspension", 7
    shows = "beams"
    changes = (
        "stiffness of the suspension in every plant; the rotation, the sideways shift and an earlier pull-in in the "
        "planar plant only, the hardening in the planar and the nonlinear one"
    )
    suggested = 1.0
    equations = (
        Equation(
            "stiffness",
            r"k\to k\,[1+s(r-1)],\quad r=1.46\ \text{at 3/4 of an inner beam},\quad r\le36EI/24EI",
            "3.1.3.2, case 3",
        ),
        Equation(
            "rotation",
            r"E=1+|\theta_1y_f|=1.01",
            "3.2.6",
            printed=r"E\cong r_2/r_1=700/350=2",
            why="a point on a beam is no pivot of the shuttle: the trusses keep it from turning",
        ),
    )

    class Params(FaultParams):
        """Severity 1 holds the point firmly; the part that grows with the travel is estimated off the fitted place."""

        severity: float = parameter(0.0, "how firmly the point is held", "1", ge=0, le=1)
        beam: Literal["inner", "outer"] = parameter("inner", "which beam")
        position: float = parameter(
            0.75, "place along the beam, from its root (0) to the truss (1)", "1", ge=0.1, le=0.95
        )

    class Ports(StructureFault.Ports):
        """The suspension."""

        severity: float = severity("1", "how firmly the point is held")

    @classmethod
    def whole(cls, params: Any, context: Context) -> FaultEffects:
        """Return a share of the effects of a point that is held firmly."""
        damage = Damage(adhesion=(params.beam, params.position))
        bending = BENDING.scaled(linear(drawn(context), damage)[3] / linear(Geometry(), FITTED)[3])
        return effects(drawn(context), damage, bending).scaled(params.severity)
