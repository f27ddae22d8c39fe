"""Stiction."""

from __future__ import annotations

from typing import Any

from core.block import TICK, Equation, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at

FRICTION, OTHER, HUMID, SEVERITY = range(4)


def stiction_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Add Coulomb friction; nN to uN."""
    severity = severity_at(p, w[TICK])
    w[io[SEVERITY]] = severity
    if severity != 0.0:
        w[io[FRICTION]] += 1e-3 * severity * w[io[HUMID]]
        w[io[OTHER]] += severity


class Stiction(Fault):
    r"""Coulomb friction :math:`F_s` of something that rubs: the shuttle sticks within :math:`F_s/k` of its place.

    Humid air makes surfaces adhere, and friction goes with the adhesion energy: 0.6 times as much in dry air, 23 times
    at 60 %. Plants that step once a sample stop the shuttle in the sample in which it turns.
    """

    title = "Stiction"
    shows = "film"
    changes = (
        "friction along x in every plant: a dead band about rest, flattened peaks, no hypothesis of a bank is true"
    )
    suggested = 20.0
    inputs = (
        *channels("friction", "other"),
        Port("humid", "1", "friction at this humidity over that at 40 %", source="environment.friction_scale"),
    )
    outputs = (Port("severity", "nN", "friction at 40 % of humidity"),)
    equations = (
        Equation("dead band", r"|x-x_0|\le F_s(H)/k", "1.5, 3.1.3.2"),
        Equation("humidity", r"F_s(H)=F_s\,W(H)/W(40)", "1.4.4, 1.5 in words; assumed"),
    )

    class Params(FaultParams):
        """Severity is the friction itself, as it is at 40 % of humidity."""

        severity: float = parameter(0.0, "friction at 40 % of humidity", "nN", ge=0, le=1e5)

    step = stiction_step
