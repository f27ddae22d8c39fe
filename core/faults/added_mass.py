"""Added mass."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import FaultParams, ScaleFault, effect, severity
from core.ports import BlockPorts


class AddedMass(ScaleFault):
    r"""Mass on the shuttle, :math:`m\to m(1+s)`."""

    title = "Added mass"
    group, place = "The usual", 1
    shows = "plate"
    changes = "mass of the shuttle; the resonance falls, the static displacement stays"
    suggested = 0.05
    axes = None
    equations = (Equation("effect", r"m\to m\,(1+s)", "5.2.4"),)

    class Params(FaultParams):
        """Severity is a share of the nominal mass."""

        severity: float = parameter(0.0, "added mass, share of nominal", "1", gt=-0.95, le=20)

    class Ports(BlockPorts):
        """The mass."""

        effect: float = effect("mass_scale")
        severity: float = severity("1", "added mass, share of nominal")
