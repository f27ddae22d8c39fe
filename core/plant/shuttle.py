"""What every plant along x shares: ports, noise, comb force."""

from __future__ import annotations

import math
from typing import Any, ClassVar

from core.block import Block, BlockParams, Context, Oscillator, Port, inlined, kernel, parameter
from core.noise import key, normal
from core.units import UN_PER_N, thermal_force_un

(
    MASS,
    DAMPING,
    STIFFNESS,
    DT,
    X0,
    V0,
    COMB,
    FIRST_V,
    SECOND_V,
    DRIVE_NOISE,
    DRIVE_KEY,
    THERMAL,
    THERMAL_KEY,
    OWN,
) = range(14)
"""Packed parameters of every plant; a plant's own start at ``OWN``."""

(
    VOLTAGE,
    MIDDLE,
    END,
    MASS_SCALE,
    STIFFNESS_SCALE,
    DAMPING_SCALE,
    DRIVE_GAIN,
    DRIVE_OFFSET,
    ACCELERATION,
    FRICTION,
    SHORTED,
    FIRST_OWN_INPUT,
) = range(12)
"""Input ports of every plant; a plant's own follow, then come the outputs and taps of ``STATE``."""

DISPLACEMENT, VELOCITY, LATERAL, SHIFT, SHIFT_VELOCITY, ROTATION, ROTATION_VELOCITY, CONTACT, SHORT = range(9)
"""Outputs and taps of every plant, counted from the first output."""
ELASTICITY_PORT = Port(
    "elasticity_scale", "1", "stiffness of all beams alike over nominal", source="effects.elasticity_scale"
)
"""Input of a plant with more elasticity than that along x."""
RIGHT, LEFT = 1, 2
"""Bits of ``SHORT``: the comb at +x, whose stator carries the first voltage, and the one at -x."""


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

    inputs: ClassVar[tuple[Port, ...]] = (
        Port("voltage", "V", "applied voltage", source="drive.voltage"),
        Port("middle", "V", "applied voltage half a sample later", source="drive.middle"),
        Port("end", "V", "applied voltage one sample later", source="drive.end"),
        Port("mass_scale", "1", "mass over nominal mass", source="effects.mass_scale"),
        Port("stiffness_scale", "1", "stiffness over nominal", source="effects.stiffness_scale"),
        Port("damping_scale", "1", "damping over nominal", source="effects.damping_scale"),
        Port("drive_gain", "1", "voltage at the comb over voltage applied", source="effects.drive_gain"),
        Port("drive_offset", "V", "voltage at the comb that nobody applied", source="effects.drive_offset"),
        Port("acceleration", "um/ms^2", "acceleration of the frame along x", source="effects.acceleration"),
        Port("friction", "uN", "Coulomb friction", source="effects.friction"),
        Port("shorted", "1", "combs shorted from outside", source="effects.short"),
    )
    outputs: ClassVar[tuple[Port, ...]] = (
        Port("displacement", "um", "true displacement of the shuttle"),
        Port("velocity", "um/ms", "true velocity of the shuttle (1 um/ms = 1 mm/s)"),
    )
    taps: ClassVar[tuple[Port, ...]] = (
        Port("lateral", "um", "sideways displacement of the fingers where it is largest"),
        Port("shift", "um", "sideways displacement of the centre"),
        Port("shift_velocity", "um/ms", "sideways velocity of the centre"),
        Port("rotation", "mrad", "rotation of the shuttle"),
        Port("rotation_velocity", "mrad/ms", "rate of rotation of the shuttle"),
        Port("contact", "1", "1 while fingers touch a stator"),
        Port("short", "1", "shorted combs, until the board is reset: 1 at +x, 2 at -x, 3 both"),
    )

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse what is no resonator."""
        return "" if device.time_unit_ms == 0.0 else "this device is no resonator; choose transfer_function"

    @classmethod
    def shared(cls, params: Any, context: Context) -> list[float]:
        """Pack what every plant needs."""
        device = context.device
        thermal = thermal_force_un(context.temperature_k, context.dt_ms) if params.thermal_noise else 0.0
        return [
            device.mass,
            device.damping,
            device.stiffness,
            context.dt_ms,
            params.initial_displacement_um,
            params.initial_velocity_um_ms,
            context.capacitance_gradient * UN_PER_N,
            *context.stator_voltages,
            params.drive_noise_v,
            key(context.seed, "plant.drive"),
            thermal,
            key(context.seed, "plant.thermal"),
        ]


@inlined
def comb_voltage_parabola(w: Any, io: Any) -> tuple[float, float, float]:
    r"""Return the voltage that reaches the comb over a sample, :math:`u_0+a(r+ab)` at the share :math:`a` of it.

    Through its start, middle and end; exactly constant when the drive holds it.
    """
    u0 = w[io[DRIVE_GAIN]] * w[io[VOLTAGE]] + w[io[DRIVE_OFFSET]]
    d1 = w[io[DRIVE_GAIN]] * w[io[MIDDLE]] + w[io[DRIVE_OFFSET]] - u0
    d2 = w[io[DRIVE_GAIN]] * w[io[END]] + w[io[DRIVE_OFFSET]] - u0
    return u0, 4.0 * d1 - d2, 2.0 * d2 - 4.0 * d1


@kernel
def comb_force(p: Any, v: float, short: float) -> float:
    r"""Force of the push-pull comb, :math:`\tfrac12 C'[(V_{b1}-v)^2-(V_{b2}-v)^2]`, uN; a shorted comb has none.

    Written as the product of difference and sum, so that identical stators give exactly nothing.
    """
    if short != 0.0:
        right = comb_voltage(p[FIRST_V] - v, short, RIGHT)
        left = comb_voltage(p[SECOND_V] - v, short, LEFT)
        return float(0.5 * p[COMB] * (right * right - left * left))
    return float(0.5 * p[COMB] * (p[FIRST_V] - p[SECOND_V]) * (p[FIRST_V] + p[SECOND_V] - 2.0 * v))


@kernel
def comb_voltage(v: float, short: float, comb: int) -> float:
    """Voltage across a comb: none once it is shorted, for its supply is behind a resistor."""
    return 0.0 if int(short) & comb else v


@inlined
def coefficients(p: Any, w: Any, io: Any) -> tuple[float, float, float]:
    """Return mass, damping and stiffness as faults and environment have made them."""
    return p[MASS] * w[io[MASS_SCALE]], p[DAMPING] * w[io[DAMPING_SCALE]], p[STIFFNESS] * w[io[STIFFNESS_SCALE]]


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
    """Return the combs that are shorted by one or the other."""
    return float(int(first) | int(second))


@kernel
def dry_friction(limit: float, velocity: float, net: float) -> float:
    """Coulomb friction: against the motion; at rest against the net force, as far as it can."""
    if velocity != 0.0:
        return -limit if velocity > 0.0 else limit
    if abs(net) <= limit:
        return -net
    return -limit if net > 0.0 else limit


@kernel
def at_rest_sideways(w: Any, io: Any, first: int, short: float) -> None:
    """Write the taps of a plant that only moves along x, whose ports of state begin at ``first``."""
    w[io[first + LATERAL]] = 0.0
    w[io[first + SHIFT]] = 0.0
    w[io[first + SHIFT_VELOCITY]] = 0.0
    w[io[first + ROTATION]] = 0.0
    w[io[first + ROTATION_VELOCITY]] = 0.0
    w[io[first + CONTACT]] = 0.0
    w[io[first + SHORT]] = short


@kernel
def drive_noise(p: Any, tick: float) -> float:
    """Voltage noise held over the interval that starts at ``tick``."""
    return p[DRIVE_NOISE] * normal(p[DRIVE_KEY], tick) if p[DRIVE_NOISE] > 0.0 else 0.0


@kernel
def thermal_force(p: Any, damping: float, tick: float) -> float:
    """Thermomechanical force held over the interval that starts at ``tick``, uN."""
    return p[THERMAL] * math.sqrt(damping) * normal(p[THERMAL_KEY], tick) if p[THERMAL] > 0.0 else 0.0
