"""Effect channels: through which faults reach the plant and the measurement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from core.block import Block, BlockParams
from core.ports import OUTPUT, BlockPorts, Port, reads
from core.record import Record


@dataclass(frozen=True)
class Channel(Port):
    """An effect channel: faults multiply it if its neutral value is 1, and add to it if that is 0."""

    neutral: float = 1.0


def _scale(meaning: str, *, hidden: bool = True) -> Any:
    return Channel("", "1", meaning, hidden=hidden, kind=OUTPUT)


def _sum(unit: str, meaning: str) -> Any:
    return Channel("", unit, meaning, hidden=True, neutral=0.0, kind=OUTPUT)


class Effects(Block):
    """The channels of faults into plant and measurement, set back to neutral before the faults of each tick.

    Stiffness, elasticity, damping, friction and squeeze film start from the values that the environment gives the
    device; for a new device at 300 K and 1 atm only the last is not neutral, by its rarefaction. Stiffness is the whole
    stiffness along x, elasticity its material part: every other stiffness of the suspension is proportional to the
    elasticity.
    """

    title = "Effect channels"

    class Params(BlockParams):
        """Nothing to choose."""

    class Ports(BlockPorts):
        """Factors of the environment in, channels out."""

        stiffness: float = reads("environment.stiffness_scale", "1", "stiffness over nominal in this environment")
        damping: float = reads("environment.damping_scale", "1", "damping over nominal in this environment")
        rubbing: float = reads("environment.friction", "uN", "friction in this environment")
        rarefied: float = reads("environment.squeeze", "1", "squeeze film in this environment, over the damping")
        mass_scale: float = _scale("true mass over nominal", hidden=False)
        stiffness_scale: float = _scale("true stiffness over nominal", hidden=False)
        damping_scale: float = _scale("true damping over nominal", hidden=False)
        drive_gain: float = _scale("voltage at the comb over the voltage applied")
        drive_offset: float = _sum("V", "stray voltage at the comb")
        acceleration: float = _sum("um/ms^2", "acceleration of the frame along x")
        acceleration_side: float = _sum("um/ms^2", "acceleration of the frame along y")
        friction: float = _sum("uN", "Coulomb friction")
        short: float = _sum("1", "combs that are shorted: 1 at +x, 2 at -x, 3 both")
        cubic: float = _sum("uN/um^3", "cubic stiffness along x")
        lateral_scale: float = _scale("stiffness along y over nominal")
        lateral_reach: float = _scale("travel over which the stiffness along y falls, over nominal")
        rotation_scale: float = _scale("stiffness against rotation over nominal")
        rotation_reach: float = _scale("travel over which the stiffness against rotation falls, over nominal")
        sideways: float = _sum("1/um", "sideways shift per squared travel")
        turn: float = _sum("rad/um", "rotation per travel")
        turn_cubic: float = _sum("rad/um^3", "rotation per cubed travel")
        other: float = _sum("1", "not zero while something is wrong that no hypothesis of a bank can say")
        vacuum: float = _scale("share of the vacuum that is left")
        sensor_offset: float = _sum("um", "added to the measurement")
        sensor_quantum: float = _sum("um", "rounding step of the measurement, 0 for none")
        sensor_held: float = _sum("1", "not zero while the sample is lost")
        squeeze_scale: float = _scale("squeeze film over its value in a continuous gas at 300 K, over the damping")
        elasticity_scale: float = _scale(
            "stiffness of all beams alike over nominal: cubic, sideways and in rotation too"
        )
        cross_stiffness: float = _sum("uN/um", "added to the stiffness that couples the first two axes")
        cross_damping: float = _sum("uN ms/um", "added to the damping that couples the first two axes")
        second_stiffness_scale: float = _scale(
            "stiffness of the second axis over nominal, in addition to the change of all axes"
        )
        second_damping_scale: float = _scale(
            "damping of the second axis over nominal, in addition to the change of all axes"
        )
        second_drive_gain: float = _scale("force on the second axis over the one applied")
        second_sensor_offset: float = _sum("um", "added to the measurement of the second axis")

    @classmethod
    def neutral(cls) -> dict[str, float]:
        """Return the value of each channel without any fault."""
        return {port.name: port.neutral for port in cls.Ports.declared if isinstance(port, Channel)}

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Start the tick without any fault."""
        x.mass_scale = 1.0
        x.drive_gain = 1.0
        x.drive_offset = 0.0
        x.acceleration = 0.0
        x.acceleration_side = 0.0
        x.short = 0.0
        x.cubic = 0.0
        x.lateral_scale = 1.0
        x.lateral_reach = 1.0
        x.rotation_scale = 1.0
        x.rotation_reach = 1.0
        x.sideways = 0.0
        x.turn = 0.0
        x.turn_cubic = 0.0
        x.vacuum = 1.0
        x.sensor_offset = 0.0
        x.sensor_quantum = 0.0
        x.sensor_held = 0.0
        x.cross_stiffness = 0.0
        x.cross_damping = 0.0
        x.second_stiffness_scale = 1.0
        x.second_damping_scale = 1.0
        x.second_drive_gain = 1.0
        x.second_sensor_offset = 0.0
        x.stiffness_scale = x.stiffness
        x.elasticity_scale = x.stiffness  # temperature and age change the material of every beam
        x.damping_scale = x.damping
        x.squeeze_scale = x.rarefied
        x.friction = x.rubbing
        x.other = x.rubbing  # no hypothesis describes friction
