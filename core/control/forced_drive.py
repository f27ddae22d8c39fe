"""Forced drive: a sine force along x, whatever x does."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.two_axis import DrivePorts, two_axis
from core.elementary import sin_of_turns
from core.ports import output
from core.record import Record
from core.units import hz_of_rad_ms


class ForcedDrive(Block):
    r"""A sine force, :math:`F_x=F\sin(2\pi ft+\varphi)`; held by a converter, or analogue.

    The carrier is the motion of x at its resonance: its velocity is in step with the force.
    """

    title = "Forced drive"
    place = 14
    axes = ("x", "y")
    slot = "drive"
    equations = (Equation("force", r"F_x=F\sin(2\pi ft+\varphi)"),)
    structure = (
        Stage("Force", "", "x frequency", ("force",)),
        Stage("Swing", "x_measured x_velocity", "amplitude"),
    )

    class Params(BlockParams):
        """The force."""

        force_un: float | None = parameter(
            None, "amplitude; the force for the device's amplitude at resonance unless given", "uN", ge=0, le=1e6
        )
        frequency_hz: float | None = parameter(
            None, "frequency; the mode nearest to x unless given", "Hz", ge=0, le=1e6
        )
        phase_deg: float = parameter(0.0, "phase at t = 0", "deg")

    class Packed(Record):
        """Amplitude of the force, frequency in turns per ms, phase in turns, sample interval."""

        force: float
        cycles: float
        start: float
        dt_ms: float

    class Ports(DrivePorts):
        """Ports of the drive slot, and the force between samples."""

        x_middle: float = output("uN", "force along x half a sample later", hidden=True)
        x_end: float = output("uN", "force along x one sample later", hidden=True)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the force."""
        device = two_axis(context)
        p = cls.Packed.blank()
        hz = hz_of_rad_ms(device.drive_frequency) if params.frequency_hz is None else params.frequency_hz
        needed = device.damping * device.drive_frequency * device.amplitude
        p.force = needed if params.force_un is None else params.force_un
        p.cycles, p.start, p.dt_ms = 1e-3 * hz, params.phase_deg / 360.0, context.dt_ms
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: ForcedDrive.Ports) -> None:
        """Play the sine."""
        turns = p.cycles * x.time_ms + p.start
        x.x = p.force * sin_of_turns(turns)
        x.x_middle = p.force * sin_of_turns(turns + 0.5 * p.cycles * p.dt_ms)
        x.x_end = p.force * sin_of_turns(turns + p.cycles * p.dt_ms)
        x.sine = sin_of_turns(turns - 0.25)
        x.cosine = sin_of_turns(turns)
        omega = 2.0 * math.pi * p.cycles
        w = x.x_velocity / omega if omega > 0.0 else 0.0
        x.amplitude = math.sqrt(x.x_measured * x.x_measured + w * w)
        x.frequency = 1e3 * p.cycles
