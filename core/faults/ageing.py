"""Ageing."""

from __future__ import annotations

from core.block import Equation, parameter
from core.device.environment import ageing_ratio
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts, reads
from core.record import Record


class Ageing(Fault):
    r"""Weeks of ageing, :math:`k\to k/r(t)`: 42.8 % less static displacement after four (3.1.3.2).

    A ramp lets the weeks pass within the run; a device that is older already continues from its age. The text gives
    only the end; the exponential and its time constant of two weeks are assumed. It is also assumed that age changes
    the material of all beams alike, as a modulus :math:`E\to E/r(t)`: the text measured along x alone. The stiffnesses
    sideways, in rotation and cubic change with it, and pull-in by the bias with :math:`1/\sqrt r`.
    """

    title = "Ageing"
    group, place = "Suspension", 9
    shows = "beams"
    changes = (
        "displacement the suspension allows, taken as the modulus of all beams; 1.748 times as stiff after four weeks, "
        "sideways and in rotation too in the planar plant"
    )
    suggested = 4.0
    axes = None
    equations = (
        Equation(
            "effect",
            r"k\to k/r(t),\quad r=1-0.428\,\frac{1-e^{-t/2}}{1-e^{-2}}\ (t\ \text{in weeks})",
            "3.1.3.2, figure 3.1.3.2.3; the law between is assumed",
        ),
    )

    class Params(FaultParams):
        """Severity is the age in weeks."""

        severity: float = parameter(0.0, "age", "week", ge=0, le=52)

    class Ports(BlockPorts):
        """The modulus of the beams, and their age."""

        stiffness_scale: float = effect("stiffness_scale")
        elasticity_scale: float = effect("elasticity_scale")
        age: float = reads("environment.age", "week", "age without the fault")
        severity: float = severity("week", "age")

    @staticmethod
    def step(p: PackedFault, s: Record, x: Ports) -> None:
        """Stiffen every beam as the loss of displacement with age requires."""
        weeks = severity_now(p, x.tick)
        x.severity = weeks
        if weeks != 0.0:
            stiffer = ageing_ratio(x.age) / ageing_ratio(x.age + weeks)
            x.stiffness_scale *= stiffer
            x.elasticity_scale *= stiffer
