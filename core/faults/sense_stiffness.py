"""Stiffness of the sensing axis."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import FaultParams, ScaleFault, effect, severity
from core.ports import BlockPorts


class SenseStiffness(ScaleFault):
    r"""Stiffness along y alone, :math:`k_{yy}\to k_{yy}(1+s)`: one axis warms up, or its tuning voltage drifts.

    The split of the modes drifts with it, by about half the share of the upper frequency, and so does the scale of an
    open-loop read-out. A loop that holds y at zero does not see it: stiffness has no effect without motion.
    """

    title = "Stiffness of the sensing axis"
    group, place = "Suspension", 5
    shows = "beams"
    changes = "stiffness along y alone, and with it the split of the modes and the scale of an open-loop read-out"
    suggested = 0.01
    axes = ("x", "y")
    equations = (Equation("effect", r"k_{yy}\to k_{yy}\,(1+s)"),)

    class Params(FaultParams):
        """Severity is a share of the stiffness along y."""

        severity: float = parameter(0.0, "added stiffness along y, share of nominal", "1", gt=-0.95, le=20)

    class Ports(BlockPorts):
        """The stiffness along y."""

        effect: float = effect("second_stiffness_scale")
        severity: float = severity("1", "added stiffness along y, share of nominal")
