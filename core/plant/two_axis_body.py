r"""A device with two axes as a plant takes it: nominal, and as it is now with the force on it."""

from __future__ import annotations

import math

from core.block import Context
from core.device.two_axis import TwoAxis
from core.elementary import sin
from core.errors import InputError
from core.kernel import kernel
from core.noise import key
from core.record import Record
from core.units import thermal_force_un

STRIDE = 2.0
"""Longest part of a sample for one series, over 1/w of the fastest mode."""
MARGIN = 2.0
"""Share by which faults may raise the fastest mode before the series ends too soon."""
REMAINDER = 1e-16
"""Size of the first term left out, over the displacement."""
MOST_PARTS = 32
"""Parts of a sample beyond which the bench is refused: the modes swing some ten times within it."""


class TwoAxisBody(Record):
    """A nominal device, its thermal noise per root of damping, and the parts and terms of a sample."""

    mass_x: float
    mass_y: float
    coriolis_mass: float
    damping_x: float
    damping_xy: float
    damping_y: float
    stiffness_x: float
    stiffness_xy: float
    stiffness_y: float
    thermal_x: float
    thermal_y: float
    key_x: float
    key_y: float
    part_ms: float
    parts: float
    terms: float


class TwoAxisMotion(Record):
    r"""A device as it is now, the force on it over one sample, and its motion.

    The force at the share a of the sample is :math:`f+a(rise+a\,bend)`.
    """

    mass_x: float
    mass_y: float
    coriolis_mass: float
    damping_x: float
    damping_xy: float
    damping_y: float
    stiffness_x: float
    stiffness_xy: float
    stiffness_y: float
    force_x: float
    rise_x: float
    bend_x: float
    force_y: float
    rise_y: float
    bend_y: float
    x: float
    y: float
    x_velocity: float
    y_velocity: float


def pack_body(b: TwoAxisBody, device: TwoAxis, context: Context, stream: str, *, thermal_noise: bool) -> None:
    r"""Pack a device.

    The held thermal force is raised by :math:`\frac{\omega h/2}{\sin\omega h/2}`, so that its density at the resonance
    of each axis equals the density of white noise.

    Raises
    ------
    InputError
        When the modes swing many times within a sample.
    """
    b.mass_x, b.mass_y, b.coriolis_mass = device.mass, device.mass_y, device.coriolis_mass
    b.damping_x, b.damping_xy, b.damping_y = device.damping, device.damping_xy, device.damping_y
    b.stiffness_x, b.stiffness_xy, b.stiffness_y = device.stiffness, device.stiffness_xy, device.stiffness_y
    parts = math.ceil(device.fastest * context.dt_ms / STRIDE)
    if parts > MOST_PARTS:
        hz = 1e3 * device.fastest / (2.0 * math.pi)
        text = f"a mode at {hz:.4g} Hz swings {device.fastest * context.dt_ms / (2.0 * math.pi):.0f} times in a sample"
        raise InputError(text, "sample_rate_khz", "sample faster")
    b.parts = parts
    b.part_ms = h = context.dt_ms / parts
    b.terms = terms_for(MARGIN * device.fastest * h)
    b.thermal_x = b.thermal_y = 0.0
    if thermal_noise:
        noise = thermal_force_un(context.temperature_k, h)
        b.thermal_x = noise / held_density(device.natural_frequency * h)
        b.thermal_y = noise / held_density(math.sqrt(device.stiffness_y / device.mass_y) * h)
    b.key_x, b.key_y = key(context.seed, f"{stream}.x"), key(context.seed, f"{stream}.y")


def terms_for(share: float) -> int:
    r"""Return the terms after which :math:`(\omega h)^n/n!` is no longer seen."""
    n, size = 2, 0.5 * share * share
    while size > REMAINDER:
        n += 1
        size *= share / n
    return n


def held_density(share: float) -> float:
    r"""Return the spectrum of a held white force at :math:`\omega h` over the spectrum of white noise."""
    return sin(0.5 * share) / (0.5 * share)


@kernel
def take(b: TwoAxisBody, m: TwoAxisMotion, mass_scale: float, stiffness_scale: float, damping_scale: float) -> None:
    """Take the nominal device with all of its masses, stiffness and damping multiplied."""
    m.mass_x = b.mass_x * mass_scale
    m.mass_y = b.mass_y * mass_scale
    m.coriolis_mass = b.coriolis_mass * mass_scale
    m.damping_x = b.damping_x * damping_scale
    m.damping_xy = b.damping_xy * damping_scale
    m.damping_y = b.damping_y * damping_scale
    m.stiffness_x = b.stiffness_x * stiffness_scale
    m.stiffness_xy = b.stiffness_xy * stiffness_scale
    m.stiffness_y = b.stiffness_y * stiffness_scale


@kernel
def push_x(m: TwoAxisMotion, start: float, middle: float, end: float, acceleration: float) -> None:
    """Set the force along x: the parabola through three values, constant if held, and the force of the frame."""
    to_middle, to_end = middle - start, end - start
    m.force_x = start - m.mass_x * acceleration
    m.rise_x, m.bend_x = 4.0 * to_middle - to_end, 2.0 * to_end - 4.0 * to_middle


@kernel
def push_y(m: TwoAxisMotion, start: float, middle: float, end: float, acceleration: float) -> None:
    """Set the force along y like that along x."""
    to_middle, to_end = middle - start, end - start
    m.force_y = start - m.mass_y * acceleration
    m.rise_y, m.bend_y = 4.0 * to_middle - to_end, 2.0 * to_end - 4.0 * to_middle
