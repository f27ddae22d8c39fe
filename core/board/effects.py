"""Effect channels: through which faults reach the plant and the measurement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, FloatArray, Port

STIFFNESS_IN, DAMPING_IN, FRICTION_IN, SQUEEZE_IN, OUTPUTS = range(5)
STIFFNESS, DAMPING, FRICTION, OTHER, SQUEEZE, ELASTICITY = 1, 2, 7, 17, 22, 23
"""Places among the outputs of the channels that start from the environment."""


@dataclass(frozen=True)
class Channel(Port):
    """An effect channel: faults multiply it if its neutral value is 1, and add to it if that is 0."""

    neutral: float = 1.0


def _scale(name: str, meaning: str, *, hidden: bool = True) -> Channel:
    return Channel(name, "1", meaning, hidden=hidden)


def _sum(name: str, unit: str, meaning: str) -> Channel:
    return Channel(name, unit, meaning, hidden=True, neutral=0.0)


def effects_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Start the tick without any fault."""
    for i in range(int(p[0])):
        w[io[OUTPUTS + i]] = p[1 + i]
    w[io[OUTPUTS + STIFFNESS]] = w[io[STIFFNESS_IN]]
    w[io[OUTPUTS + ELASTICITY]] = w[io[STIFFNESS_IN]]  # temperature and age change the material of every beam
    w[io[OUTPUTS + DAMPING]] = w[io[DAMPING_IN]]
    w[io[OUTPUTS + SQUEEZE]] = w[io[SQUEEZE_IN]]
    w[io[OUTPUTS + FRICTION]] = w[io[FRICTION_IN]]
    w[io[OUTPUTS + OTHER]] = w[io[FRICTION_IN]]  # no hypothesis says friction


class Effects(Block):
    """The channels through which faults reach plant and measurement, set back to neutral before those of each tick.

    Stiffness, elasticity, damping, friction and squeeze film start from what the environment makes of the device; for a
    new one at 300 K and 1 atm only the last is not neutral, by its rarefaction. Stiffness is the whole of that along x,
    elasticity the part of it that is the material: every other stiffness of the suspension goes with it.
    """

    title = "Effect channels"
    inputs = (
        Port("stiffness", "1", "stiffness over nominal in this environment", source="environment.stiffness_scale"),
        Port("damping", "1", "damping over nominal in this environment", source="environment.damping_scale"),
        Port("rubbing", "uN", "friction in this environment", source="environment.friction"),
        Port("rarefied", "1", "squeeze film in this environment, over the damping", source="environment.squeeze"),
    )
    outputs = (
        _scale("mass_scale", "true mass over nominal", hidden=False),
        _scale("stiffness_scale", "true stiffness over nominal", hidden=False),
        _scale("damping_scale", "true damping over nominal", hidden=False),
        _scale("drive_gain", "voltage at the comb over the voltage applied"),
        _sum("drive_offset", "V", "voltage at the comb that nobody applied"),
        _sum("acceleration", "um/ms^2", "acceleration of the frame along x"),
        _sum("acceleration_side", "um/ms^2", "acceleration of the frame along y"),
        _sum("friction", "uN", "Coulomb friction"),
        _sum("short", "1", "combs that are shorted: 1 at +x, 2 at -x, 3 both"),
        _sum("cubic", "uN/um^3", "cubic stiffness along x"),
        _scale("lateral_scale", "stiffness along y over nominal"),
        _scale("lateral_reach", "travel over which the stiffness along y falls, over nominal"),
        _scale("rotation_scale", "stiffness against rotation over nominal"),
        _scale("rotation_reach", "travel over which the stiffness against rotation falls, over nominal"),
        _sum("sideways", "1/um", "sideways shift per squared travel"),
        _sum("turn", "rad/um", "rotation per travel"),
        _sum("turn_cubic", "rad/um^3", "rotation per cubed travel"),
        _sum("other", "1", "not zero while something is wrong that no hypothesis of a bank can say"),
        _scale("vacuum", "share of the vacuum that is left"),
        _sum("sensor_offset", "um", "added to what is measured"),
        _sum("sensor_quantum", "um", "step what is measured is rounded to, 0 for none"),
        _sum("sensor_held", "1", "not zero while the sample is lost"),
        _scale("squeeze_scale", "squeeze film over that of a continuous gas at 300 K, over the damping"),
        _scale("elasticity_scale", "stiffness of all beams alike over nominal: cubic, sideways and in rotation too"),
    )

    class Params(BlockParams):
        """Nothing to choose."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Return the number of channels and what each is without any fault."""
        return np.array([float(len(cls.outputs)), *cls.neutral()])

    @classmethod
    def neutral(cls) -> list[float]:
        """Return the value of each channel without any fault."""
        return [port.neutral for port in cls.outputs]

    step = effects_step
