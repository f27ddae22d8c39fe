"""Damping."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import FaultParams, ScaleFault, effect, severity
from core.ports import BlockPorts


class Damping(ScaleFault):
    r"""Damping of the gas film, :math:`\beta\to\beta(1+s)`."""

    title = "Damping"
    group, place = "The usual", 3
    shows = "film"
    changes = "damping of the gas film; only what happens near resonance changes much"
    suggested = 0.3
    axes = None
    equations = (
        Equation("effect", r"\beta\to\beta\,(1+s)", "5.2.4 (the caption of 5.2.4.1.3 calls it spring constant)"),
    )

    class Params(FaultParams):
        """Severity is a share of the nominal damping."""

        severity: float = parameter(0.0, "added damping, share of nominal", "1", gt=-0.95, le=20)

    class Ports(BlockPorts):
        """The damping."""

        effect: float = effect("damping_scale")
        severity: float = severity("1", "added damping, share of nominal")
