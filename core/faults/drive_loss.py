"""Loss of drive."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record


class DriveLoss(Fault):
    r"""Part of the electrode along x is cut off, :math:`F_x\to F_x(1-s)`; at severity 1 nothing drives.

    A loop that holds the amplitude makes up for it with more force, as far as its limit allows.
    """

    title = "Loss of drive"
    group, place = "Drive and combs", 14
    shows = "drive"
    changes = "force that reaches the mass along x; controllers and diagnosers still read the force applied"
    suggested = 0.5
    axes = ("x", "y")
    equations = (Equation("effect", r"F_x\to F_x\,(1-s)"),)

    class Params(FaultParams):
        """Severity is the share of the force that is lost."""

        severity: float = parameter(0.0, "share of the force along x that is lost", "1", ge=0, le=1)

    class Ports(BlockPorts):
        """The force along x."""

        drive_gain: float = effect("drive_gain")
        severity: float = severity("1", "share of the force along x that is lost")

    @staticmethod
    def step(p: PackedFault, s: Record, x: Ports) -> None:
        """Take a share of the force away."""
        lost = severity_now(p, x.tick)
        x.severity = lost
        if lost != 0.0:
            x.drive_gain *= 1.0 - lost
