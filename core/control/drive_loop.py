"""Drive loop: amplitude control and a phase-locked loop keep x swinging at its resonance."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.tracking import Phasor, TrackingGains, fill_tracking, follow
from core.control.two_axis import DrivePorts, PartnerPorts, two_axis
from core.elementary import cos, floor, sin
from core.ports import tap
from core.record import Record

LEAST = 1e-3
"""Share of the desired amplitude below which there is no phase to lock to."""


class DriveLoop(Block):
    r"""Holds the amplitude of x and follows its resonance.

    .. math:: \theta'=\omega,\quad\epsilon=\frac{x\cos\theta-(\dot x/\omega)\sin\theta}{|x|_A},\quad
        \omega=\omega_0+K_p\epsilon+K_i\int\epsilon\,dt

    .. math:: F_x=F\cos(\theta+\omega h/2),\quad F=K_{pa}(A-|x|_A)+K_{ia}\int(A-|x|_A)\,dt,\quad
        |x|_A^2=x^2+(\dot x/\omega)^2

    The force is in step with the velocity, so x swings where that is so, at its resonance. A held force is late by half
    a sample; the half sample in its phase makes up for it. The gains follow from the two bandwidths: of the loop of the
    phase, and of the amplitude, whose plant is :math:`\dot A=F/2m\omega-\sigma A`.

    A partner, the model of 6.1.4, is made to follow the same carrier, :math:`x_m=A\sin\theta`: sense axes are compared
    at one frequency, amplitude and phase, and with a loop of its own the partner would swing at its own resonance. Its
    errors die away with the bandwidth of the amplitude loop.
    """

    title = "Drive loop (amplitude and phase)"
    place = 16
    axes = ("x", "y")
    slot = "drive"
    equations = (
        Equation(
            "phase",
            r"\epsilon=\frac{x\cos\theta-(\dot x/\omega)\sin\theta}{A},\quad"
            r"\dot\theta=\omega_0+K_p\epsilon+K_i\int\epsilon\,dt",
        ),
        Equation("amplitude", r"F=K_{pa}(A_0-A)+K_{ia}\int(A_0-A)\,dt,\quad A^2=x^2+(\dot x/\omega)^2"),
        Equation("force", r"F_x=F\cos(\theta+\omega h/2)"),
        Equation("partner", r"x_m\to A_0\sin\theta", "6.1.4"),
    )
    structure = (
        Stage("Swing", "x_measured x_velocity", "amplitude"),
        Stage("Phase loop", "x_measured x_velocity", "phase_error frequency", ("phase",)),
        Stage("Amplitude loop", "amplitude", "force", ("amplitude",)),
        Stage("Carrier", "force frequency", "x", ("force",)),
        Stage("Partner", "partner_measured partner_velocity frequency", "partner_x", ("partner",)),
    )

    class Params(BlockParams):
        """Amplitude and bandwidths."""

        amplitude_um: float | None = parameter(
            None, "amplitude to hold; the device's own unless given", "um", gt=0, le=100
        )
        phase_bandwidth_hz: float = parameter(100.0, "bandwidth of the phase-locked loop", "Hz", gt=0, le=1e5)
        amplitude_bandwidth_hz: float = parameter(50.0, "bandwidth of the amplitude loop", "Hz", gt=0, le=1e5)
        limit_un: float = parameter(100.0, "most force", "uN", gt=0, le=1e6)
        advance: bool = parameter(True, "advance the force by half a sample, by which a held one is late")

    class Packed(Record):
        """Gains, nominal frequency, interval, force per change of amplitude; the law of a partner."""

        target: float
        omega: float
        dt_ms: float
        phase_gain: float
        phase_integral: float
        gain: float
        integral: float
        limit_un: float
        advance: float
        partner: TrackingGains

    class State(Record):
        """Phase in turns, integrals of phase and force, the force of a partner."""

        turns: float
        omega: float
        force: float
        partner: Phasor

    class Ports(DrivePorts, PartnerPorts):
        """Ports of the drive slot, a partner, and the outputs of the loops."""

        force: float = tap("uN", "amplitude of the force")
        phase_error: float = tap("rad", "phase of x against the carrier")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        r"""Pack the gains: both loops with a damping ratio of 1, :math:`K_p=2w,K_i=w^2`."""
        device = two_axis(context)
        p = cls.Packed.blank()
        p.omega, p.dt_ms = device.drive_frequency, context.dt_ms
        p.target = amplitude(params, context)
        phase, loop = (2.0 * math.pi * hz * 1e-3 for hz in (params.phase_bandwidth_hz, params.amplitude_bandwidth_hz))
        p.phase_gain, p.phase_integral = 2.0 * phase, phase * phase
        per_force = 2.0 * device.mass * p.omega
        p.gain, p.integral = 2.0 * loop * per_force, loop * loop * per_force
        fill_tracking(p.partner, p.target, device.mass, loop, p.omega, p.dt_ms)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """At the nominal frequency."""
        s = cls.State.zeros()
        s.omega = two_axis(context).drive_frequency
        return s

    @staticmethod
    def step(p: Packed, s: State, x: DriveLoop.Ports) -> None:
        """Lock the phase, hold the amplitude; a loop that does not drive only follows x."""
        angle = 2.0 * math.pi * s.turns
        sine, cosine = sin(angle), cos(angle)
        w = x.x_velocity / s.omega
        size = math.sqrt(x.x_measured * x.x_measured + w * w)
        error = 0.0
        if size > LEAST * p.target:
            error = (x.x_measured * cosine - w * sine) / size
        missing = p.target - size
        force = s.force + p.gain * missing
        if x.engaged != 0.0:
            # integrate only if that does not push the force further into its limit
            if abs(force) <= p.limit_un or force * missing < 0.0:
                s.force += p.integral * missing * p.dt_ms
        force = min(max(force, -p.limit_un), p.limit_un)
        ahead = angle + 0.5 * p.advance * s.omega * p.dt_ms
        x.x = force * cos(ahead)
        x.force = force
        x.phase_error = error
        late = 0.5 * s.omega * p.dt_ms
        carrier = (s.omega, sine, cosine, sin(angle + late), cos(angle + late))
        x.partner_x, _ = follow(p.partner, s.partner, x.partner_measured, x.partner_velocity, carrier, x.engaged)
        x.amplitude = size
        x.frequency = 1e3 * s.omega / (2.0 * math.pi)
        x.sine = sine
        x.cosine = cosine
        s.omega += p.phase_integral * error * p.dt_ms
        turns = s.turns + (s.omega + p.phase_gain * error) * p.dt_ms / (2.0 * math.pi)
        s.turns = turns - floor(turns)


def amplitude(params: Any, context: Context) -> float:
    """Return the amplitude of x to hold, um."""
    return float(params.amplitude_um or two_axis(context).amplitude)
