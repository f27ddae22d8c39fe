"""Ports, noise and comb force of the plants along x."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Oscillator, parameter
from core.device.two_axis import TwoAxis
from core.kernel import kernel
from core.noise import normal
from core.ports import BlockPorts, output, reads, tap
from core.record import Record, stream
from core.units import UN_PER_N, thermal_force_un

ELASTICITY = reads("effects.elasticity_scale", "1", "stiffness of all beams alike over nominal")
"""Input of a plant with more elasticity than that along x."""
RIGHT, LEFT = 1, 2
"""Bits of ``short``: the comb at +x, whose stator carries the first voltage, and the comb at -x."""


class PackedMotion(Record):
    """Mass, damping, stiffness, interval, start and noise of the drive, for every plant along x."""

    mass: float
    damping: float
    stiffness: float
    dt_ms: float
    initial_displacement_um: float
    initial_velocity_um_ms: float
    drive_noise_v: float
    drive_key: float = stream("plant.drive")


class ShuttleParams(BlockParams):
    """Starting point and noise of the shuttle, and the gap of its combs."""

    initial_displacement_um: float = parameter(0.0, "displacement at the start", "um", ge=-20, le=20, live=False)
    initial_velocity_um_ms: float = parameter(0.0, "velocity at the start", "um/ms", live=False)
    drive_noise_v: float = parameter(0.0, "white noise on the drive voltage, rms per sample", "V", ge=0)
    thermal_noise: bool = parameter(True, "thermomechanical force noise of the damping")
    gap_um: float | None = parameter(
        None,
        "gap between fingers as etched, instead of the device's; force, capacitance and pull-in go with it",
        "um",
        gt=0.2,
        le=100,
        equation="1.3.2",
        live=False,
    )


class Shuttle(Block):
    """A plant along x; its state is its own output signals, so one plant can replace another while running."""

    class Packed(PackedMotion):
        """In addition the comb (capacitance gradient in uN/V^2, voltages of the stators) and thermal noise."""

        capacitance_gradient: float
        first_v: float
        second_v: float
        thermal: float
        thermal_key: float = stream("plant.thermal")

    class Ports(BlockPorts):
        """Inputs of every plant, then the inputs of one kind of plant; then the motion and state it writes."""

        voltage: float = reads("drive.voltage", "V", "applied voltage")
        middle: float = reads("drive.middle", "V", "applied voltage half a sample later")
        end: float = reads("drive.end", "V", "applied voltage one sample later")
        mass_scale: float = reads("effects.mass_scale", "1", "mass over nominal mass")
        stiffness_scale: float = reads("effects.stiffness_scale", "1", "stiffness over nominal")
        damping_scale: float = reads("effects.damping_scale", "1", "damping over nominal")
        drive_gain: float = reads("effects.drive_gain", "1", "voltage at the comb over voltage applied")
        drive_offset: float = reads("effects.drive_offset", "V", "stray voltage at the comb")
        acceleration: float = reads("effects.acceleration", "um/ms^2", "acceleration of the frame along x")
        friction: float = reads("effects.friction", "uN", "Coulomb friction")
        shorted: float = reads("effects.short", "1", "combs shorted from outside")
        displacement: float = output("um", "true displacement of the shuttle")
        velocity: float = output("um/ms", "true velocity of the shuttle (1 um/ms = 1 mm/s)")
        lateral: float = tap("um", "sideways displacement of the fingers where it is largest")
        shift: float = tap("um", "sideways displacement of the centre")
        shift_velocity: float = tap("um/ms", "sideways velocity of the centre")
        rotation: float = tap("mrad", "rotation of the shuttle")
        rotation_velocity: float = tap("mrad/ms", "rate of rotation of the shuttle")
        contact: float = tap("1", "1 while fingers touch a stator")
        short: float = tap("1", "shorted combs, until the board is reset: 1 at +x, 2 at -x, 3 both")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices that are not resonators along x alone."""
        if isinstance(device, TwoAxis):
            return "this device has two axes; choose gyroscope"
        return "" if device.time_unit_ms == 0.0 else "this device is no resonator; choose transfer_function"

    @classmethod
    def pack(cls, params: Any, context: Context) -> Any:
        """Pack the numbers that every plant needs."""
        device = context.device
        p = cls.Packed.blank()
        p.mass = device.mass
        p.damping = device.damping
        p.stiffness = device.stiffness
        p.dt_ms = context.dt_ms
        p.capacitance_gradient = context.capacitance_gradient * UN_PER_N
        p.first_v, p.second_v = context.stator_voltages
        p.thermal = thermal_force_un(context.temperature_k, context.dt_ms) if params.thermal_noise else 0.0
        return p


@kernel
def comb_voltage_parabola(x: Shuttle.Ports) -> tuple[float, float, float]:
    r"""Return the voltage that reaches the comb over a sample, :math:`u_0+a(r+ab)` at the share :math:`a` of it.

    The parabola runs through the start, middle and end, and is exactly constant when the drive holds the voltage.
    """
    u0 = x.drive_gain * x.voltage + x.drive_offset
    d1 = x.drive_gain * x.middle + x.drive_offset - u0
    d2 = x.drive_gain * x.end + x.drive_offset - u0
    return u0, 4.0 * d1 - d2, 2.0 * d2 - 4.0 * d1


@kernel
def comb_force(p: Shuttle.Packed, v: float, short: float) -> float:
    r"""Force of the push-pull comb, :math:`\tfrac12 C'[(V_{b1}-v)^2-(V_{b2}-v)^2]`, uN; a shorted comb has none.

    Written as the product of difference and sum, so that identical stators give exactly nothing.
    """
    if short != 0.0:
        right = comb_voltage(p.first_v - v, short, RIGHT)
        left = comb_voltage(p.second_v - v, short, LEFT)
        return float(0.5 * p.capacitance_gradient * (right * right - left * left))
    return float(0.5 * p.capacitance_gradient * (p.first_v - p.second_v) * (p.first_v + p.second_v - 2.0 * v))


@kernel
def comb_voltage(v: float, short: float, comb: int) -> float:
    """Voltage across a comb: 0 once it is shorted, because its supply is behind a resistor."""
    return 0.0 if int(short) & comb else v


@kernel
def coefficients(p: PackedMotion, x: Shuttle.Ports) -> tuple[float, float, float]:
    """Return mass, damping and stiffness with the effects of faults and environment."""
    return p.mass * x.mass_scale, p.damping * x.damping_scale, p.stiffness * x.stiffness_scale


@kernel
def wall(at: float, stiffness: float, damping: float, x: float, v: float) -> float:
    """Return the force of a wall to either side at the distance ``at``, a spring with a damper, uN."""
    over = abs(x) - at
    if over <= 0.0:
        return 0.0
    push = stiffness * over
    return (-push if x > 0.0 else push) - damping * v


@kernel
def joined(first: float, second: float) -> float:
    """Return the combs that either of two effects has shorted."""
    return float(int(first) | int(second))


@kernel
def dry_friction(limit: float, velocity: float, net: float) -> float:
    """Coulomb friction: against the motion; without motion against the net force, as far as it can."""
    if velocity != 0.0:
        return -limit if velocity > 0.0 else limit
    if abs(net) <= limit:
        return -net
    return -limit if net > 0.0 else limit


@kernel
def at_rest_sideways(x: Shuttle.Ports, short: float) -> None:
    """Write the taps of a plant that only moves along x."""
    x.lateral = 0.0
    x.shift = 0.0
    x.shift_velocity = 0.0
    x.rotation = 0.0
    x.rotation_velocity = 0.0
    x.contact = 0.0
    x.short = short


@kernel
def drive_noise(p: PackedMotion, tick: float) -> float:
    """Voltage noise held over the interval that starts at ``tick``."""
    return p.drive_noise_v * normal(p.drive_key, tick) if p.drive_noise_v > 0.0 else 0.0


@kernel
def thermal_force(p: Shuttle.Packed, damping: float, tick: float) -> float:
    """Thermomechanical force held over the interval that starts at ``tick``, uN."""
    return p.thermal * math.sqrt(damping) * normal(p.thermal_key, tick) if p.thermal > 0.0 else 0.0
