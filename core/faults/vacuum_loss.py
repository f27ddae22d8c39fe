"""Loss of vacuum."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record


class VacuumLoss(Fault):
    r"""Air leaks into the package, :math:`p\to p+s(p_1-p)` with :math:`p_1` of one atmosphere.

    The effect depends on ``environment.pressure_pa``: from 10 Pa the quality factor falls from about 2400 to 4.9,
    most of it within the first hundredths of the ramp; in a package that is open already the fault has no effect.
    Section 5.2.2 lets the viscosity change; in fact the viscosity does not depend on pressure, but the slip at the
    walls does.
    """

    title = "Loss of vacuum"
    group, place = "Gas and friction", 10
    shows = "film"
    changes = "pressure at the device, and with it the damping of the gas"
    suggested = 1.0
    equations = (
        Equation(
            "effect",
            r"p\to p+s\,(p_1-p),\quad p_1=101325\ \text{Pa}",
            "5.2.2 (no law given)",
        ),
    )

    class Params(FaultParams):
        """Severity is the share of the vacuum that is lost."""

        severity: float = parameter(0.0, "share of the vacuum that is lost", "1", ge=0, le=1)

    class Ports(BlockPorts):
        """The loss of vacuum."""

        effect: float = effect("vacuum")
        severity: float = severity("1", "share of the vacuum that is lost")

    @staticmethod
    def step(p: PackedFault, s: Record, x: Ports) -> None:
        """Let air in."""
        lost = severity_now(p, x.tick)
        x.severity = lost
        if lost != 0.0:
            x.effect *= 1.0 - lost
