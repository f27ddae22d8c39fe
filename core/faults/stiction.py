"""Stiction."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts, reads
from core.record import Record


class Stiction(Fault):
    r"""Coulomb friction :math:`F_s` of something that rubs: the shuttle sticks within :math:`F_s/k` of its place.

    Humid air makes surfaces adhere, and friction is proportional to the adhesion energy: 0.6 times as much in dry air,
    23 times at 60 %. Plants that step once a sample stop the shuttle in the sample in which it turns.
    """

    title = "Stiction"
    group, place = "Gas and friction", 12
    shows = "film"
    changes = (
        "friction along x in every plant: a dead band about rest, flattened peaks, no hypothesis of a bank is true"
    )
    suggested = 20.0
    equations = (
        Equation("dead band", r"|x-x_0|\le F_s(H)/k", "1.5, 3.1.3.2"),
        Equation("humidity", r"F_s(H)=F_s\,W(H)/W(40)", "1.4.4, 1.5 in words; assumed"),
    )

    class Params(FaultParams):
        """Severity is the friction itself, as it is at 40 % of humidity."""

        severity: float = parameter(0.0, "friction at 40 % of humidity", "nN", ge=0, le=1e5)

    class Ports(BlockPorts):
        """The friction, and the humidity."""

        friction: float = effect("friction")
        other: float = effect("other")
        humid: float = reads("environment.friction_scale", "1", "friction at this humidity over that at 40 %")
        severity: float = severity("nN", "friction at 40 % of humidity")

    @staticmethod
    def step(p: PackedFault, s: Record, x: Ports) -> None:
        """Add Coulomb friction; nN to uN."""
        now = severity_now(p, x.tick)
        x.severity = now
        if now != 0.0:
            x.friction += 1e-3 * now * x.humid
            x.other += now
