r"""Shared parts of controllers of two axes: ports, components of a motion along the carrier, nominal sense axis.

The drive slot swings x as :math:`x=A\sin\theta`; its controllers put out the carrier, :math:`\sin\theta` and
:math:`\cos\theta`. A motion along y has a part in step with x and a part in step with its velocity,
:math:`y=Y_s\sin\theta+Y_c\cos\theta`, and so has a force. Turning by :math:`\Omega` pushes y by
:math:`-2m_c\Omega A\omega\cos\theta`, the cross stiffness by :math:`-k_{xy}A\sin\theta`.
"""

from __future__ import annotations

from typing import cast

from core.block import Context
from core.device.two_axis import TwoAxis
from core.elementary import exp
from core.kernel import kernel
from core.ports import BlockPorts, output, reads
from core.record import Record
from core.units import rate_deg_s


class TwoAxisMeasuredPorts(BlockPorts):
    """The measurements of both axes, and whether the controller drives."""

    x_measured: float = reads("sensor.x.displacement", "um", "measured displacement along x")
    y_measured: float = reads("sensor.y.displacement", "um", "measured displacement along y")
    x_velocity: float = reads("sensor.x.velocity", "um/ms", "measured velocity along x")
    y_velocity: float = reads("sensor.y.velocity", "um/ms", "measured velocity along y")
    engaged: float = reads("@engaged", "1", "1 while this controller drives in its slot")


class DrivePorts(BlockPorts):
    """Ports of every controller of the drive slot: x in, its force and the carrier out."""

    x_measured: float = reads("sensor.x.displacement", "um", "measured displacement along x")
    x_velocity: float = reads("sensor.x.velocity", "um/ms", "measured velocity along x")
    engaged: float = reads("@engaged", "1", "1 while this controller drives in its slot")
    x: float = output("uN", "force along x this controller asks for")
    amplitude: float = output("um", "amplitude of x")
    frequency: float = output("Hz", "frequency of the carrier")
    sine: float = output("1", "carrier in step with the displacement along x", hidden=True)
    cosine: float = output("1", "carrier in step with the velocity along x", hidden=True)


class PartnerPorts(BlockPorts):
    """The drive axis of a partner, on a bench that has one."""

    partner_measured: float = reads("sensor.partner_x.displacement?", "um", "measured displacement of the partner")
    partner_velocity: float = reads("sensor.partner_x.velocity?", "um/ms", "measured velocity of the partner")
    partner_x: float = output("uN", "force along x of a partner")


class RatePorts(TwoAxisMeasuredPorts):
    """Ports of every controller of the sense slot: the carrier in, the rate it reads out."""

    sine: float = reads("@drive.sine", "1", "carrier in step with the displacement along x")
    cosine: float = reads("@drive.cosine", "1", "carrier in step with the velocity along x")
    amplitude: float = reads("@drive.amplitude", "um", "amplitude of x")
    frequency: float = reads("@drive.frequency", "Hz", "frequency of the carrier")
    softening: float = reads("@tuning.softening", "uN/um", "stiffness along y that a tuning electrode takes away")
    rate: float = output("deg/s", "angular rate this controller reads")


class TuningPorts(BlockPorts):
    """Ports of every controller of the tuning slot: the voltage on the plates, and what read-outs should know of it."""

    engaged: float = reads("@engaged", "1", "1 while this controller drives in its slot")
    tuning: float = output("V", "voltage on the tuning electrode")
    softening: float = output("uN/um", "stiffness along y that it takes away, as far as this controller knows")
    pilot: float = output("uN", "force along y besides the drive's, to measure the split by", hidden=True)


class Sense(Record):
    r"""The nominal sense axis at the drive frequency.

    Its dynamic stiffness :math:`k_{yy}-m_y\omega^2+j\omega d_{yy}`, uN/um, and the factors that turn a force per
    amplitude into a rate: :math:`1/2m_c\omega` at that frequency, deg/s per uN/um, and :math:`1/2m_c` per speed, deg/s
    per uN ms/um.
    """

    spring: float
    damper: float
    dps: float
    per_speed: float


def two_axis(context: Context) -> TwoAxis:
    """Return the nominal device, which has two axes wherever such a controller is allowed."""
    return cast(TwoAxis, context.device)


def fill_sense(p: Sense, device: TwoAxis) -> None:
    """Pack the sense axis of a device."""
    omega = device.drive_frequency
    sense = device.sense(omega)
    p.spring, p.damper = sense.real, sense.imag
    p.dps = rate_deg_s(1.0 / (2.0 * device.coriolis_mass * omega))
    p.per_speed = rate_deg_s(1.0 / (2.0 * device.coriolis_mass))


@kernel
def components(q: float, v: float, omega: float, sine: float, cosine: float) -> tuple[float, float]:
    r"""Return :math:`Q_s,Q_c` of :math:`q=Q_s\sin\theta+Q_c\cos\theta` from displacement and velocity.

    With both there is no ripple at twice the frequency, as there is where a displacement alone is demodulated.
    """
    w = v / omega if omega > 0.0 else 0.0
    return q * sine + w * cosine, q * cosine - w * sine


def share_kept(time_ms: float, dt_ms: float) -> float:
    """Return the share that a low-pass with this time constant keeps from sample to sample."""
    return exp(-dt_ms / time_ms)
