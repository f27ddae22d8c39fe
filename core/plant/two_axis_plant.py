r"""Plant of a mass on two axes of a plane that turns: ports, starting point, and how faults and environment enter."""

from __future__ import annotations

import math
from typing import Any, ClassVar

from core.block import Block, BlockParams, Context, Oscillator, parameter
from core.device.two_axis import TwoAxis
from core.elementary import atan2
from core.kernel import flush_tiny, kernel
from core.plant.two_axis_body import TwoAxisBody, TwoAxisMotion, pack_body, push_x, push_y, take
from core.plant.two_axis_motion import advance
from core.ports import BlockPorts, output, reads, tap
from core.record import Record
from core.units import DEG_PER_RAD, RAD_MS_PER_DEG_S


class TwoAxisPorts(BlockPorts):
    """Forces along two axes, the rate, effects of faults and environment on the device; its motion."""

    force_x: float = reads("drive.x.force", "uN", "force along x")
    middle_x: float = reads("drive.x.middle", "uN", "force along x half a sample later")
    end_x: float = reads("drive.x.end", "uN", "force along x one sample later")
    force_y: float = reads("drive.y.force", "uN", "force along y")
    middle_y: float = reads("drive.y.middle", "uN", "force along y half a sample later")
    end_y: float = reads("drive.y.end", "uN", "force along y one sample later")
    rate: float = reads("rate.rate", "deg/s", "rate the plane turns with")
    mass_scale: float = reads("effects.mass_scale", "1", "mass over nominal mass")
    stiffness_scale: float = reads("effects.stiffness_scale", "1", "stiffness over nominal")
    damping_scale: float = reads("effects.damping_scale", "1", "damping over nominal")
    drive_gain: float = reads("effects.drive_gain", "1", "force along x over the one applied")
    second_drive_gain: float = reads("effects.second_drive_gain", "1", "force along y over the one applied")
    cross_stiffness: float = reads("effects.cross_stiffness", "uN/um", "added to k_xy")
    cross_damping: float = reads("effects.cross_damping", "uN ms/um", "added to d_xy")
    second_stiffness_scale: float = reads("effects.second_stiffness_scale", "1", "k_yy over its share of stiffness")
    second_damping_scale: float = reads("effects.second_damping_scale", "1", "d_yy over its share of damping")
    acceleration: float = reads("effects.acceleration", "um/ms^2", "acceleration of the frame along x")
    acceleration_side: float = reads("effects.acceleration_side", "um/ms^2", "acceleration of the frame along y")
    x: float = output("um", "true displacement along x, the driven axis")
    y: float = output("um", "true displacement along y, the sensing axis")
    x_velocity: float = output("um/ms", "true velocity along x")
    y_velocity: float = output("um/ms", "true velocity along y")
    energy: float = tap("pJ", "kinetic and elastic energy, also uN um")
    angle: float = tap("deg", "angle of the line of oscillation against x")
    area: float = tap("um^2", "area of the orbit, signed; 0 on a line")


class TwoAxisPlant(Block):
    """A plant that moves along x and y and is turned; its state is its own output signals, as of a shuttle."""

    slots: ClassVar[dict[str, str]] = {"drive": "drive_loop", "sense": "open_loop_rate"}
    generators: ClassVar[dict[str, str]] = {"rate": "rate", "waveform": "reference"}
    usual_sensor = "pick_off"

    class Params(BlockParams):
        """Starting point and noise."""

        initial_x_um: float = parameter(0.0, "displacement along x at the start", "um", ge=-100, le=100, live=False)
        initial_y_um: float = parameter(0.0, "displacement along y at the start", "um", ge=-100, le=100, live=False)
        initial_x_velocity_um_ms: float = parameter(0.0, "velocity along x at the start", "um/ms", live=False)
        initial_y_velocity_um_ms: float = parameter(0.0, "velocity along y at the start", "um/ms", live=False)
        thermal_noise: bool = parameter(True, "thermomechanical force noise of the damping of both axes")

    class Packed(Record):
        """The device, and the start."""

        body: TwoAxisBody
        initial_x_um: float
        initial_y_um: float
        initial_x_velocity_um_ms: float
        initial_y_velocity_um_ms: float

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices with one axis."""
        return "" if isinstance(device, TwoAxis) else "this device has one axis; choose one with two"

    @classmethod
    def pack(cls, params: Any, context: Context) -> Any:
        """Pack the device."""
        p = cls.Packed.blank()
        device: Any = context.device
        pack_body(p.body, device, context, "plant", thermal_noise=params.thermal_noise)
        return p


@kernel
def start(p: TwoAxisPlant.Packed, x: TwoAxisPorts) -> None:
    """Set position and velocity to their initial values at the first tick."""
    if x.tick == 0.0:
        x.x, x.y = p.initial_x_um, p.initial_y_um
        x.x_velocity, x.y_velocity = p.initial_x_velocity_um_ms, p.initial_y_velocity_um_ms


@kernel
def move(b: TwoAxisBody, m: TwoAxisMotion, x: TwoAxisPorts) -> None:
    """Advance a device with the effects of faults and environment, unless it starts; write energy and orbit."""
    take_now(b, m, x)
    go(b, m, x, 0.0)


@kernel
def take_now(b: TwoAxisBody, m: TwoAxisMotion, x: TwoAxisPorts) -> None:
    """Take a device with the effects of faults and environment."""
    take(b, m, x.mass_scale, x.stiffness_scale, x.damping_scale)
    m.damping_xy += x.cross_damping
    m.damping_y *= x.second_damping_scale
    m.stiffness_xy += x.cross_stiffness
    m.stiffness_y *= x.second_stiffness_scale


@kernel
def go(b: TwoAxisBody, m: TwoAxisMotion, x: TwoAxisPorts, pilot: float) -> None:
    """Advance a device as it is now, with a held force along y besides the drive's, unless it starts."""
    if x.tick > 0.0:
        gain = x.drive_gain
        push_x(m, gain * x.force_x, gain * x.middle_x, gain * x.end_x, x.acceleration)
        gain = x.second_drive_gain
        push_y(m, gain * x.force_y, gain * x.middle_y, gain * x.end_y, x.acceleration_side)
        m.force_y += pilot
        m.x, m.y, m.x_velocity, m.y_velocity = x.x, x.y, x.x_velocity, x.y_velocity
        advance(b, m, x.rate * RAD_MS_PER_DEG_S, x.tick - 1.0)
        x.x, x.y = flush_tiny(m.x), flush_tiny(m.y)
        x.x_velocity, x.y_velocity = flush_tiny(m.x_velocity), flush_tiny(m.y_velocity)
    look(m, x)


@kernel
def look(m: TwoAxisMotion, x: TwoAxisPorts) -> None:
    """Write energy and orbit."""
    q1, q2, v1, v2 = x.x, x.y, x.x_velocity, x.y_velocity
    kinetic = m.mass_x * v1 * v1 + m.mass_y * v2 * v2
    x.energy = 0.5 * (kinetic + q1 * (m.stiffness_x * q1 + 2.0 * m.stiffness_xy * q2) + m.stiffness_y * q2 * q2)
    square = (m.mass_x + m.mass_y) / (m.stiffness_x + m.stiffness_y)
    x.angle = (
        0.5 * DEG_PER_RAD * atan2(2.0 * (q1 * q2 + square * v1 * v2), q1 * q1 - q2 * q2 + square * (v1 * v1 - v2 * v2))
    )
    x.area = math.pi * math.sqrt(square) * (q1 * v2 - q2 * v1)
