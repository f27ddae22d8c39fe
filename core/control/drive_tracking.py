"""Drive tracking: x of a device, and of its partner, swings along a given sine."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.drive_loop import amplitude
from core.control.tracking import Phasor, TrackingGains, fill_tracking, follow
from core.control.two_axis import DrivePorts, PartnerPorts, two_axis
from core.elementary import cos, floor, sin
from core.ports import tap
from core.record import Record
from core.units import hz_of_rad_ms


class DriveTracking(Block):
    r"""Holds x to :math:`x_m=A\sin\omega t`, the same sine for both devices of a pair.

    The force is computed by ``core.control.tracking``. Two devices in a comparison, or in synchronism, need drive axes
    that are held: a force along y of one device pulls its x off the frequency of the other.
    """

    title = "Drive tracking"
    place = 17
    axes = ("x", "y")
    slot = "drive"
    equations = (
        Equation("law", r"F_x=f_s\sin\theta+f_c\cos\theta-2m\sigma\dot e,\quad e=x-A\sin\omega t", "6.1.4"),
        Equation(
            "adaptation",
            r"\dot f_s=\lambda\,2m\sigma\omega E_c,\quad\dot f_c=-\lambda\,2m\sigma\omega E_s,\quad\lambda=\sigma/4",
        ),
    )
    structure = (
        Stage("Sine asked for", "", "frequency"),
        Stage("Swing", "x_measured x_velocity", "amplitude"),
        Stage("Error", "x_measured frequency", "error"),
        Stage("Adaptation", "x_measured x_velocity frequency", "own", ("adaptation",)),
        Stage("Law", "own x_velocity frequency", "x", ("law",)),
        Stage("Partner", "partner_measured partner_velocity frequency", "partner_x partner_error", ("law",)),
    )

    class Params(BlockParams):
        """The sine, and how fast x comes to it."""

        amplitude_um: float | None = parameter(
            None, "amplitude to hold; the device's own unless given", "um", gt=0, le=100
        )
        frequency_hz: float | None = parameter(
            None, "frequency; the mode nearest to x unless given", "Hz", gt=0, le=1e6
        )
        damping_per_ms: float = parameter(1.0, "rate with which an error dies away", "1/ms", gt=0, le=100)

    class Packed(Record):
        """The sine, half a sample in rad, the law."""

        cycles: float
        omega: float
        half_sample: float
        law: TrackingGains

    class State(Record):
        """The forces of both devices."""

        own: Phasor
        partner: Phasor

    class Ports(DrivePorts, PartnerPorts):
        """Ports of the drive slot, and the drive axis of a partner."""

        error: float = tap("um", "displacement along x minus the sine asked for")
        partner_error: float = tap("um", "the same of a partner")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the sine and the gains."""
        device = two_axis(context)
        p = cls.Packed.blank()
        hz = params.frequency_hz or hz_of_rad_ms(device.drive_frequency)
        p.cycles, p.omega = 1e-3 * hz, 2e-3 * math.pi * hz
        p.half_sample = 0.5 * p.omega * context.dt_ms
        target = amplitude(params, context)
        fill_tracking(p.law, target, device.mass, params.damping_per_ms, p.omega, context.dt_ms)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: DriveTracking.Ports) -> None:
        """Hold both to the sine; the forces adapt while the controller drives."""
        cycles = p.cycles * x.time_ms
        angle = 2.0 * math.pi * (cycles - floor(cycles))
        sine, cosine = sin(angle), cos(angle)
        carrier = (p.omega, sine, cosine, sin(angle + p.half_sample), cos(angle + p.half_sample))
        x.x, x.error = follow(p.law, s.own, x.x_measured, x.x_velocity, carrier, x.engaged)
        x.partner_x, x.partner_error = follow(
            p.law, s.partner, x.partner_measured, x.partner_velocity, carrier, x.engaged
        )
        w = x.x_velocity / p.omega
        x.amplitude = math.sqrt(x.x_measured * x.x_measured + w * w)
        x.frequency = 1e3 * p.cycles
        x.sine = sine
        x.cosine = cosine
