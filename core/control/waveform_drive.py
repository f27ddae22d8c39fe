"""Waveform drive: a force amplifier along one axis, fed by a generator of voltage."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.two_axis import DrivePorts, two_axis
from core.ports import output, reads
from core.record import Record
from core.units import hz_of_rad_ms

LEAST_UM = 1e-9
"""Swing of x below which it has no phase."""


class WaveformDrive(Block):
    r"""A force along one axis from the waveform of the bench, :math:`F=gr(t)`; held by a converter, or analogue.

    Any reference may be the waveform: a swept sine, tones, steps, a binary sequence. The carrier is the swing of x
    itself, :math:`\sin\theta=x/A,\;\cos\theta=\dot x/\omega A`, with the frequency of the mode nearest to x, because a
    waveform need not have any one frequency. A force along y is applied where no controller of the sense slot sets a
    force.
    """

    title = "Waveform drive"
    place = 15
    axes = ("x", "y")
    slot = "drive"
    equations = (
        Equation("force", r"F=g\,r(t)"),
        Equation("carrier", r"A^2=x^2+(\dot x/\omega)^2,\quad\sin\theta=x/A,\quad\cos\theta=\dot x/\omega A"),
    )
    structure = (
        Stage("Amplifier", "waveform", "x y", ("force",)),
        Stage("Carrier", "x_measured x_velocity", "amplitude frequency", ("carrier",)),
    )

    class Params(BlockParams):
        """The amplifier."""

        gain_un_v: float = parameter(1.0, "force per volt of the waveform", "uN/V", ge=-1e6, le=1e6)
        axis: Literal["x", "y"] = parameter("x", "axis of the force")

    class Packed(Record):
        """Gains along both axes, frequency of the mode nearest to x in rad/ms and in Hz."""

        gain_x: float
        gain_y: float
        omega: float
        hz: float

    class Ports(DrivePorts):
        """The waveform; ports of the drive slot, with forces along both axes, between samples too."""

        waveform: float = reads("waveform.voltage", "V", "waveform")
        waveform_middle: float = reads("waveform.middle", "V", "waveform half a sample later")
        waveform_end: float = reads("waveform.end", "V", "waveform one sample later")
        y: float = output("uN", "force along y this controller asks for")
        x_middle: float = output("uN", "force along x half a sample later", hidden=True)
        x_end: float = output("uN", "force along x one sample later", hidden=True)
        y_middle: float = output("uN", "force along y half a sample later", hidden=True)
        y_end: float = output("uN", "force along y one sample later", hidden=True)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack gains and frequency."""
        p = cls.Packed.blank()
        p.gain_x, p.gain_y = (params.gain_un_v if params.axis == axis else 0.0 for axis in cls.axes)
        p.omega = two_axis(context).drive_frequency
        p.hz = hz_of_rad_ms(p.omega)
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: WaveformDrive.Ports) -> None:
        """Amplify the waveform, and look at the swing of x."""
        x.x = p.gain_x * x.waveform
        x.x_middle = p.gain_x * x.waveform_middle
        x.x_end = p.gain_x * x.waveform_end
        x.y = p.gain_y * x.waveform
        x.y_middle = p.gain_y * x.waveform_middle
        x.y_end = p.gain_y * x.waveform_end
        w = x.x_velocity / p.omega
        size = math.sqrt(x.x_measured * x.x_measured + w * w)
        swings = size > LEAST_UM
        x.sine = x.x_measured / size if swings else 0.0
        x.cosine = w / size if swings else 0.0
        x.amplitude = size
        x.frequency = p.hz
