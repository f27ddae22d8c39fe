"""Stiction."""

from __future__ import annotations

from typing import Any

from core.block import Equation, Port, parameter
from core.faults.fault import Fault, FaultParams, channels, severity_at


def stiction_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Add Coulomb friction; nN to uN."""
    severity = severity_at(p, w[0])
    w[io[2]] = severity
    if severity != 0.0:
        w[io[0]] += 1e-3 * severity
        w[io[1]] += severity


class Stiction(Fault):
    r"""Coulomb friction :math:`F_s` of something that rubs: the shuttle sticks within :math:`F_s/k` of its place.

    Plants that step once a sample stop the shuttle in the sample in which it turns.
    """

    title = "Stiction"
    shows = "film"
    changes = (
        "friction along x in every plant: a dead band about rest, flattened peaks, no hypothesis of a bank is true"
    )
    suggested = 20.0
    inputs = channels("friction", "other")
    outputs = (Port("severity", "nN", "friction"),)
    equations = (Equation("dead band", r"|x-x_0|\le F_s/k", "1.5, 3.1.3.2"),)

    class Params(FaultParams):
        """Severity is the friction itself."""

        severity: float = parameter(0.0, "friction", "nN", ge=0, le=1e5)

    step = stiction_step
