r"""Feed-through from the drive to the pick-off of the sensing axis."""

from __future__ import annotations

from core.block import Equation, parameter
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts, reads
from core.record import Record
from core.units import PM_PER_UM


class FeedThrough(Fault):
    r"""A parasitic capacitance :math:`C_p` passes the voltage of the drive on to the pick-off along y.

    The charge :math:`C_pv_x` counts like the charge :math:`2\frac{dC}{dy}V_by` of a displacement. With the force per
    volt of both combs, :math:`\kappa=2\frac{dC}{dx}V_b`, it is

    .. math:: z_y\to z_y+sF_x,\quad s=\frac{C_p}{\kappa_x\kappa_y} .

    At resonance the force of the drive, :math:`d_{xx}\omega A`, is in step with the velocity of x, as the swing of y
    under a rate is. An open-loop read-out takes it for a rate. It weighs displacement and velocity alike, and the
    velocity has a pick-off of its own, away from the drive, so

    .. math:: \Omega_p=-\frac{s\,d_{xx}(k_{yy}-m_y\omega^2)}{4m_c},

    whatever the amplitude.
    """

    title = "Feed-through of the drive"
    group, place = "Measurement", 23
    shows = "sensor"
    changes = "measured displacement along y, by a share of the force of the drive; a read-out takes it for a rate"
    suggested = 1000.0
    axes = ("x", "y")
    equations = (
        Equation("effect", r"z_y\to z_y+sF_x,\quad s=\frac{C_p}{\kappa_x\kappa_y}", "not in the text"),
        Equation("as a rate", r"\Omega_p=-\frac{s\,d_{xx}(k_{yy}-m_y\omega^2)}{4m_c}", "not in the text"),
    )

    class Params(FaultParams):
        """Severity is the displacement along y that a force of the drive shows as."""

        severity: float = parameter(0.0, "displacement along y per force of the drive", "pm/uN", ge=-1e9, le=1e9)

    class Ports(BlockPorts):
        """The force of the drive, and the error added to the measurement along y."""

        force: float = reads("drive.x.force", "uN", "force of the drive along x")
        second_sensor_offset: float = effect("second_sensor_offset")
        other: float = effect("other")
        severity: float = severity("pm/uN", "displacement along y per force of the drive")

    @staticmethod
    def step(p: PackedFault, s: Record, x: Ports) -> None:
        """Pass the drive on to the pick-off along y."""
        passed = severity_now(p, x.tick)
        x.severity = passed
        if passed != 0.0:
            x.second_sensor_offset += passed * x.force / PM_PER_UM
            x.other += 1.0
