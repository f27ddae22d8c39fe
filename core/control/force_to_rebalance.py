"""Force to rebalance: y is held at zero, and the necessary force is the rate."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.two_axis import RatePorts, Sense, components, fill_sense, share_kept, two_axis
from core.elementary import atan2, cos, sin
from core.ports import output, tap
from core.record import Record

USUAL_SHARE = 0.436
"""Bandwidth of the loop over the damping rate of y, unless a gain is given; from 1 on the split of the modes rings."""


class ForceToRebalance(Block):
    r"""Holds y at zero with a force in step with the velocity of x, the rate, and one with x, the quadrature.

    .. math:: F_y=u_c\cos\theta'+u_s\sin\theta',\quad\dot u_s+j\dot u_c=-gm_y\frac{D-k_e}{|D|}(Y_s+jY_c)

    .. math:: \hat\Omega=\frac{u_c}{2m_c\omega A},\quad\hat\Omega_q=\frac{u_s}{2m_c\omega A}

    :math:`\omega` is the frequency of the carrier: with y at zero x rings at :math:`\sqrt{k_{xx}/m_x}`, 3.7 % above the
    mode of set A. :math:`D=k_{yy}-m_y\omega^2+j\omega d_{yy}` is nominal, and :math:`k_e` is the stiffness that a
    tuning electrode takes away, as far as its controller knows: the force has the phase that y needs, also at matched
    modes. A held force is late by half a sample, :math:`\omega h/2`, so without ``advance`` a part
    :math:`\Omega_q\sin(\omega h/2)` of the quadrature reads as a rate, and :math:`\theta'=\theta+\omega h/2`
    compensates it. The loop is stable below the gain :math:`g<|D|\,d_{yy}/2m_y^2`, the damping of y against the split
    of the modes. With the share :math:`\lambda` of this gain and :math:`\sigma=d_{yy}/2m_y`, a rate passes at matched
    modes as

    .. math:: \frac{\hat\Omega}\Omega=\frac{\lambda\sigma^2}{s^2+\sigma s+\lambda\sigma^2},

    stable with every gain, and far apart as :math:`\lambda\sigma/(s+\lambda\sigma)`. A split :math:`\Delta` in place
    of the split :math:`\rho` that it counts with is stable while :math:`\sigma^2+\rho(\Delta-\lambda\rho)>0`.
    """

    title = "Force to rebalance"
    place = 19
    axes = ("x", "y")
    slot = "sense"
    equations = (
        Equation("force", r"F_y=u_c\cos\theta'+u_s\sin\theta',\quad\theta'=\theta+\omega h/2"),
        Equation("rate", r"\hat\Omega=\frac{u_c}{2m_c\omega A},\quad\hat\Omega_q=\frac{u_s}{2m_c\omega A}"),
        Equation("thermal floor", r"\sqrt2\,\frac{\sqrt{4k_BTd_{yy}}}{2m_c\omega A}"),
    )
    structure = (
        Stage("Demodulation", "y_measured y_velocity frequency", "rest_in_step rest_with_velocity"),
        Stage("Integrators", "rest_in_step rest_with_velocity", "in_step with_velocity"),
        Stage("Force", "in_step with_velocity", "y", ("force",)),
        Stage("Rate", "in_step with_velocity amplitude frequency", "rate quadrature", ("rate", "thermal floor")),
    )
    weaknesses = (
        "One frequency does not tell the rate from the cross damping, so d_xy/2m_c is read as a rate: 57 deg/s on set "
        "A, 216 on set B. Nothing says by how much the rate is off.",
        "The loop needs 2m/(0.436 d) to settle, 0.46 s on set A.",
        "It rings where the split of the modes is less than 0.43 of the split it counts with, as after a loss of 1.5 % "
        "of the stiffness along y on gyro-c. At matched modes it holds whatever the spring then does.",
    )

    class Params(BlockParams):
        """The loop and its phase."""

        integral_gain_per_ms3: float | None = parameter(
            None, "integral gain g; 0.436 of the limit by the damping of y unless given", "1/ms^3", ge=0, le=1e6
        )
        advance: bool = parameter(True, "advance the force by half a sample, by which a held one is late")
        phase_error_deg: float = parameter(0.0, "error of the phase of the force", "deg", ge=-180, le=180)
        bandwidth_hz: float = parameter(50.0, "bandwidth of the low-pass behind the rate", "Hz", gt=0, le=1e5)

    class Packed(Record):
        """Sense axis, gain per sample with its phase and for each softening, phase of the force, low-pass."""

        sense: Sense
        gain_cosine: float
        gain_sine: float
        per_softening: float
        lead: float
        ahead: float
        kept: float

    class State(Record):
        """Forces in step with the velocity of x and with x, uN; the two rates behind the low-pass."""

        with_velocity: float
        in_step: float
        rate: float
        quadrature: float

    class Ports(RatePorts):
        """Ports of the sense slot, the force along y and the rest of y."""

        y: float = output("uN", "force along y this controller asks for")
        quadrature: float = output("deg/s", "cross stiffness, read as a rate")
        rest_in_step: float = tap("um", "residual of y in step with x")
        rest_with_velocity: float = tap("um", "residual of y in step with the velocity of x")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the gain and the phases."""
        device = two_axis(context)
        p = cls.Packed.blank()
        fill_sense(p.sense, device)
        size, phase = abs(complex(p.sense.spring, p.sense.damper)), atan2(p.sense.damper, p.sense.spring)
        gain = params.integral_gain_per_ms3
        if gain is None:
            gain = USUAL_SHARE * size / device.mass_y * device.damping_y / (2.0 * device.mass_y)
        per_sample = gain * device.mass_y * context.dt_ms
        p.gain_cosine, p.gain_sine = per_sample * cos(phase), per_sample * sin(phase)
        p.per_softening = per_sample / size
        p.lead = math.radians(params.phase_error_deg)
        p.ahead = 0.5 * context.dt_ms if params.advance else 0.0
        p.kept = share_kept(1e3 / (2.0 * math.pi * params.bandwidth_hz), context.dt_ms)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: ForceToRebalance.Ports) -> None:
        """Demodulate y, integrate while it drives, and put the force on."""
        omega = 2e-3 * math.pi * x.frequency
        in_step, with_velocity = components(x.y_measured, x.y_velocity, omega, x.sine, x.cosine)
        if x.engaged != 0.0:
            gain_cosine = p.gain_cosine - p.per_softening * x.softening
            s.in_step -= gain_cosine * in_step - p.gain_sine * with_velocity
            s.with_velocity -= gain_cosine * with_velocity + p.gain_sine * in_step
        turn = p.lead + p.ahead * omega
        turn_cosine, turn_sine = cos(turn), sin(turn)
        sine = x.sine * turn_cosine + x.cosine * turn_sine
        cosine = x.cosine * turn_cosine - x.sine * turn_sine
        x.y = s.with_velocity * cosine + s.in_step * sine
        speed = omega * x.amplitude
        if speed > 1e-6:
            per_force = p.sense.per_speed / speed
            s.rate += (1.0 - p.kept) * (per_force * s.with_velocity - s.rate)
            s.quadrature += (1.0 - p.kept) * (per_force * s.in_step - s.quadrature)
        x.rate = s.rate
        x.quadrature = s.quadrature
        x.rest_in_step = in_step
        x.rest_with_velocity = with_velocity
