"""Loss of vacuum."""

from __future__ import annotations

from typing import Any

from core.block import TICK, Equation, Port, parameter
from core.faults.fault import Fault, FaultParams, channel, severity_at

EFFECT, LOST = range(2)


def vacuum_loss_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Let air in."""
    lost = severity_at(p, w[TICK])
    w[io[LOST]] = lost
    if lost != 0.0:
        w[io[EFFECT]] *= 1.0 - lost


class VacuumLoss(Fault):
    r"""Air leaks into the package, :math:`p\to p+s(p_1-p)` with :math:`p_1` of one atmosphere.

    What it does depends on ``environment.pressure_pa``: from 10 Pa the quality factor falls from about 2400 to 4.9,
    most of it within the first hundredths of the ramp; in a package that is open already it does nothing. Section
    5.2.2 has the viscosity change; it does not depend on pressure, the slip at the walls does.
    """

    title = "Loss of vacuum"
    shows = "film"
    changes = "pressure at the device, and with it the damping of the gas"
    suggested = 1.0
    inputs = channel("vacuum")
    outputs = (Port("severity", "1", "share of the vacuum that is lost"),)
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

    step = vacuum_loss_step
