"""What every plant along x shares: ports, noise, comb force."""

from __future__ import annotations

import math
from typing import Any, ClassVar

from core.block import Block, BlockParams, Context, Port, kernel, parameter
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

VOLTAGE, MIDDLE, END, MASS_SCALE, STIFFNESS_SCALE, DAMPING_SCALE, DISPLACEMENT, VELOCITY = range(8)
"""Ports of every plant."""


class ShuttleParams(BlockParams):
    """Starting point and noise of the shuttle."""

    initial_displacement_um: float = parameter(0.0, "displacement at the start", "um", ge=-20, le=20, live=False)
    initial_velocity_um_ms: float = parameter(0.0, "velocity at the start", "um/ms", live=False)
    drive_noise_v: float = parameter(0.0, "white noise on the drive voltage, rms per sample", "V", ge=0)
    thermal_noise: bool = parameter(True, "thermomechanical force noise of the damping")


class Shuttle(Block):
    """A plant along x; its state is its own output signals, so one plant can replace another while running."""

    inputs: ClassVar = (
        Port("voltage", "V", "applied voltage", source="drive.voltage"),
        Port("middle", "V", "applied voltage half a sample later", source="drive.middle"),
        Port("end", "V", "applied voltage one sample later", source="drive.end"),
        Port("mass_scale", "1", "mass over nominal mass", source="effects.mass_scale"),
        Port("stiffness_scale", "1", "stiffness over nominal", source="effects.stiffness_scale"),
        Port("damping_scale", "1", "damping over nominal", source="effects.damping_scale"),
    )
    outputs: ClassVar = (
        Port("displacement", "um", "true displacement of the shuttle"),
        Port("velocity", "um/ms", "true velocity of the shuttle (1 um/ms = 1 mm/s)"),
    )

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


@kernel
def comb_force(p: Any, v: float) -> float:
    r"""Force of the push-pull comb, :math:`\tfrac12 C'[(V_{b1}-v)^2-(V_{b2}-v)^2]`, uN.

    Written as the product of difference and sum, so that identical stators give exactly nothing.
    """
    return float(0.5 * p[COMB] * (p[FIRST_V] - p[SECOND_V]) * (p[FIRST_V] + p[SECOND_V] - 2.0 * v))


@kernel
def drive_noise(p: Any, tick: float) -> float:
    """Voltage noise held over the interval that starts at ``tick``."""
    return p[DRIVE_NOISE] * normal(p[DRIVE_KEY], tick) if p[DRIVE_NOISE] > 0.0 else 0.0


@kernel
def thermal_force(p: Any, damping: float, tick: float) -> float:
    """Thermomechanical force held over the interval that starts at ``tick``, uN."""
    return p[THERMAL] * math.sqrt(damping) * normal(p[THERMAL_KEY], tick) if p[THERMAL] > 0.0 else 0.0
