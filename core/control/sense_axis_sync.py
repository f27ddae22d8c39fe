"""Sense-axis synchronisation: a force along y makes a gyroscope swing as its partner does, or not at all."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.open_loop_rate import FilteredComponents, ReadOut, ReadPorts, fill_read_out, read
from core.control.two_axis import components, share_kept, two_axis
from core.elementary import atan2, cos, sin
from core.ports import output, reads, tap
from core.record import Record
from core.units import DEG_PER_RAD


class SenseAxisSync(Block):
    r"""Makes y follow the y of the partner, :math:`e=y-y_m\to0`; or zero, :math:`y_m=0`, which is drift reduction.

    .. math:: F_y=-c_d\dot e-\hat\theta_1x-\hat\theta_2\dot x/\omega,\quad
        \dot{\hat\theta}_1=g\,\dot e\,x,\quad\dot{\hat\theta}_2=g\,\dot e\,\dot x/\omega

    The differences between the two are proportional to x and its velocity, so both forces are learned. With
    :math:`V=\tfrac12m\dot e^2+\tfrac12ke^2+\tfrac1{2g}|\tilde\theta|^2`, :math:`\dot V=-(d+c_d)\dot e^2`. The gain is
    :math:`g=4m\sigma\lambda\,(1+\Delta^2/\sigma^2)/A^2` with :math:`c_d=2m\sigma` and the split :math:`\Delta` of the
    modes, so that the error dies away with the rate :math:`\lambda`.

    A partner with errors of its own hands them on: the reading is then its zero-rate output. With y at zero the rate is
    in the force, :math:`\hat\Omega=u_c/2m_c\omega A`, and the rest of the zero rate is the cross damping.

    At zero, with ``drive_tracking`` in the drive slot, this is the adaptive law of Leland (2006, recalled and checked
    for consistency only): x follows a sine of a given frequency, y is driven to zero, and the factors of x and its
    velocity are adapted by the velocity error. Over a period the products average to
    :math:`\dot{\hat\theta}_1=-\tfrac12g\omega Y_c,\;\dot{\hat\theta}_2=\tfrac12g\omega Y_s`. That is the integral of
    ``force_to_rebalance``, :math:`\dot u_s+j\dot u_c=-g_Fm_ye^{j\psi}(Y_s+jY_c)`, with :math:`u_s=-\hat\theta_1,
    u_c=-\hat\theta_2,\psi=90^\circ` and :math:`g_F=g\omega/2m_y`, on an axis with the damping :math:`d_{yy}+c_d`. One
    frequency does not separate the rate from the cross damping: the reading is :math:`\Omega+d_{xy}/2m_c`.
    """

    title = "Sense-axis synchronisation"
    place = 20
    axes = ("x", "y")
    slot = "sense"
    equations = (
        Equation("law", r"F_y=-2m\sigma\dot e-\hat\theta_1x-\hat\theta_2\dot x/\omega,\quad e=y-y_m", "6.1.4"),
        Equation("adaptation", r"\dot{\hat\theta}_1=g\dot ex,\quad\dot{\hat\theta}_2=g\dot e\dot x/\omega"),
        Equation(
            "average over a period",
            r"\dot{\hat\theta}_1=-\tfrac12g\omega Y_c,\quad\dot{\hat\theta}_2=\tfrac12g\omega Y_s",
            "Leland 2006, recalled",
        ),
        Equation(
            "force at the end",
            r"F_y=(k_{yy}-m\omega^2+j\omega d_{yy})\,y_m+(k_{xy}+j\omega d_{xy})\,A",
            "6.1.4",
            printed=r"\text{the control command is very small}",
            why="with modes 674 Hz apart the force along y is 33 times that along x; only matched modes make it small",
        ),
        Equation(
            "drift",
            r"\Omega_0\to\Omega_{0,m}",
            "6.1.5",
            printed=r"\text{synchronisation reduces the drift}",
            why="a model with errors of 2 degrees hands on its own 10.0 deg/s; only y held at zero, or a model without "
            "errors, takes the quadrature out of the rate",
        ),
    )
    structure = (
        Stage("Error", "y_measured partner_y", "error"),
        Stage(
            "Adaptation",
            "x_measured x_velocity y_velocity partner_y_velocity",
            "with_x with_velocity",
            ("adaptation", "average over a period"),
        ),
        Stage("Learned force", "with_x with_velocity x_measured x_velocity", "learned", ("force at the end",)),
        Stage("Law", "learned y_velocity partner_y_velocity", "y", ("law",)),
        Stage("Read-out", "y_measured y_velocity frequency amplitude", "swing rate quadrature", ("drift",)),
        Stage(
            "Read-out of the partner",
            "partner_y partner_y_velocity amplitude frequency",
            "partner_rate phase_difference",
        ),
    )
    weaknesses = (
        "At rest one frequency does not tell the rate from the cross damping: d_xy/2m_c is read as a rate, 57 deg/s on "
        "set A, 216 on set B at 1 MHz and -118 at 100 kHz. Nothing says by how much the rate is off.",
    )

    class Params(BlockParams):
        """The target of y, and the speed of the adaptation."""

        follow: Literal["partner", "rest"] = parameter("partner", "y of the partner, or no swing at all")
        rate_per_ms: float = parameter(0.25, "rate with which the forces are learned", "1/ms", gt=0, le=10)
        damping_per_ms: float | None = parameter(
            None, "damping added over the mass; the split of the modes unless given", "1/ms", gt=0, le=100
        )
        bandwidth_hz: float = parameter(20.0, "bandwidth of each of two low-passes behind the rate", "Hz", gt=0, le=1e5)
        phase_error_deg: float = parameter(0.0, "error of the phase of the demodulation", "deg", ge=-180, le=180)
        correct_phase: bool = parameter(False, "turn y back by the phase of the nominal sense axis")

    class Packed(Record):
        """Read-out, target of y, damping, gain per sample, amplitude, low-pass of the force, half a sample."""

        read_out: ReadOut
        rest: float
        added_damping: float
        gain: float
        amplitude: float
        kept: float
        half_ms: float

    class State(Record):
        """Components of y, forces over x and its velocity, components of the force and of the y that is followed."""

        swing: FilteredComponents
        with_x: float
        with_velocity: float
        force_cosine: float
        force_sine: float
        model_in_step: float
        model_with_velocity: float

    class Ports(ReadPorts):
        """Ports of a read-out, the partner, the force along y, how far the two are in step."""

        partner_y: float = reads("sensor.partner_y.displacement?", "um", "measured displacement of the partner along y")
        partner_y_velocity: float = reads("sensor.partner_y.velocity?", "um/ms", "measured velocity of the partner")
        y: float = output("uN", "force along y this controller asks for")
        error: float = tap("um", "y minus its target")
        learned: float = tap("uN", "part of the force that has been learned")
        phase_difference: float = tap("deg", "phase of y against the partner's y")
        partner_rate: float = tap("deg/s", "rate read from the swing of the partner")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack read-out and gains."""
        device = two_axis(context)
        p = cls.Packed.blank()
        fill_read_out(p.read_out, params, context)
        p.rest = params.follow == "rest"
        omega = device.drive_frequency
        split = abs((device.stiffness_y / device.mass_y) ** 0.5 - omega)
        sigma = params.damping_per_ms or max(split, params.rate_per_ms)
        p.added_damping = 2.0 * device.mass_y * sigma
        p.amplitude, p.half_ms = device.amplitude, 0.5 * context.dt_ms
        p.gain = 4.0 * device.mass_y * (sigma + split * split / sigma) * params.rate_per_ms * context.dt_ms
        p.kept = share_kept(1e3 / (2.0 * math.pi * params.bandwidth_hz), context.dt_ms)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: SenseAxisSync.Ports) -> None:
        """Follow the partner, learn while it drives, and read the rate."""
        read(p.read_out, s.swing, x)
        omega = 2e-3 * math.pi * x.frequency
        model, model_velocity = x.partner_y, x.partner_y_velocity
        if p.rest != 0.0:
            model, model_velocity = 0.0, 0.0
        e, v = x.y_measured - model, x.y_velocity - model_velocity
        along = x.x_measured / p.amplitude
        across = x.x_velocity / (omega * p.amplitude) if omega > 0.0 else 0.0
        learned = s.with_x * along + s.with_velocity * across
        x.y = -p.added_damping * v - learned
        x.error = e
        x.learned = learned
        if x.engaged != 0.0:
            s.with_x += p.gain * v * along
            s.with_velocity += p.gain * v * across
        # of the forces per amplitude of x, and of the partner's swing
        s.force_sine += (1.0 - p.kept) * (-s.with_x - s.force_sine)
        s.force_cosine += (1.0 - p.kept) * (-s.with_velocity - s.force_cosine)
        in_step, with_velocity = components(x.partner_y, x.partner_y_velocity, omega, x.sine, x.cosine)
        s.model_in_step += (1.0 - p.kept) * (in_step - s.model_in_step)
        s.model_with_velocity += (1.0 - p.kept) * (with_velocity - s.model_with_velocity)
        if x.amplitude > 1e-6:
            per_amplitude = p.read_out.sense.dps / x.amplitude
            x.partner_rate = -per_amplitude * p.read_out.sense.spring * s.model_with_velocity
            if p.rest != 0.0:
                # as it acts: held, it is late by half a sample
                turn_cosine, turn_sine = cos(p.half_ms * omega), sin(p.half_ms * omega)
                per_force = p.read_out.sense.per_speed / (omega * x.amplitude) if omega > 0.0 else 0.0
                x.rate = per_force * (s.force_cosine * turn_cosine - s.force_sine * turn_sine)
                x.quadrature = per_force * (s.force_sine * turn_cosine + s.force_cosine * turn_sine)
        phase = atan2(s.swing.with_velocity, s.swing.in_step) - atan2(s.model_with_velocity, s.model_in_step)
        x.phase_difference = DEG_PER_RAD * (
            phase - 2.0 * math.pi * (phase > math.pi) + 2.0 * math.pi * (phase < -math.pi)
        )
