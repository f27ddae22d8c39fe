"""Effect of faults of the suspension on its whole elasticity.

The part that is linear in the displacement comes from a frame of beams with the drawing of the device. The part that
changes with the travel was fitted to the frame of LCR-350 at large displacements, for the named places.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from core.block import Context
from core.device.frame import Damage, along_x, stiffness
from core.device.geometry import Geometry
from core.faults.fault import Fault, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record


class FaultEffects(Record):
    """Effect of a fault on each channel at full severity: added shares of five scales, then four sums themselves."""

    stiffness: float
    lateral: float
    lateral_reach: float
    rotation: float
    rotation_reach: float
    cubic: float
    sideways: float
    turn: float
    turn_cubic: float

    def scaled(self, factor: float) -> FaultEffects:
        """Return a share of the effects."""
        return FaultEffects(factor * self.array)


@dataclass(frozen=True)
class Bending:
    """Effects that grow with the travel: reaches over nominal, then cubic N/m^3, sideways 1/m, turn rad/m^3."""

    reach_y: float = 1.0
    reach_t: float = 1.0
    cubic: float = 0.0
    sideways: float = 0.0
    turn_cubic: float = 0.0

    def scaled(self, factor: float) -> Bending:
        """Return a share of the effects."""
        return Bending(
            1.0 + factor * (self.reach_y - 1.0),
            1.0 + factor * (self.reach_t - 1.0),
            factor * self.cubic,
            factor * self.sideways,
            factor * self.turn_cubic,
        )


@lru_cache(maxsize=256)
def linear(geometry: Geometry, damage: Damage) -> tuple[float, float, float, float]:
    """Return the stiffness along x, along y and against rotation over nominal, and the turn per travel, rad/um."""
    whole, hurt = stiffness(geometry), stiffness(geometry, damage)
    # the turn without a torque at a travel, with the shuttle free sideways
    coupling = hurt[2, 0] - hurt[2, 1] * hurt[1, 0] / hurt[1, 1]
    turning = hurt[2, 2] - hurt[2, 1] * hurt[1, 2] / hurt[1, 1]
    return (
        along_x(hurt) / along_x(whole),
        float(hurt[1, 1] / whole[1, 1]),
        float(hurt[2, 2] / whole[2, 2]),
        float(-coupling / turning),
    )


def effects(geometry: Geometry, damage: Damage, bending: Bending) -> FaultEffects:
    """Return the effect of the full fault on each channel: added shares for scales, the sums themselves."""
    along, sideways, turning, turn = linear(geometry, damage)
    whole = FaultEffects.zeros()
    whole.stiffness = along - 1.0
    whole.lateral = sideways - 1.0
    whole.lateral_reach = bending.reach_y - 1.0
    whole.rotation = turning - 1.0
    whole.rotation_reach = bending.reach_t - 1.0
    whole.cubic = bending.cubic * 1e-12
    whole.sideways = bending.sideways * 1e-6
    whole.turn = turn
    whole.turn_cubic = bending.turn_cubic * 1e-18
    return whole


class StructureFault(Fault):
    """A fault of the suspension; a subclass gives its effects at full severity."""

    class Packed(PackedFault):
        """Severity and profile with the effects at full severity behind them."""

        effects: FaultEffects

    class Ports(BlockPorts):
        """The suspension: five scales, then four sums."""

        stiffness_scale: float = effect("stiffness_scale")
        lateral_scale: float = effect("lateral_scale")
        lateral_reach: float = effect("lateral_reach")
        rotation_scale: float = effect("rotation_scale")
        rotation_reach: float = effect("rotation_reach")
        cubic: float = effect("cubic")
        sideways: float = effect("sideways")
        turn: float = effect("turn")
        turn_cubic: float = effect("turn_cubic")
        severity: float = severity("1", "present severity")

    @classmethod
    def whole(cls, params: Any, context: Context) -> FaultEffects:
        """Return the effects at full severity, which is not 0."""
        raise NotImplementedError

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack severity, profile and effects."""
        p: StructureFault.Packed = super().pack(params, context)
        p.effects = cls.whole(params, context) if params.severity != 0.0 else FaultEffects.zeros()
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Change the suspension by the present severity's share of the effects."""
        now = severity_now(p, x.tick)
        x.severity = now
        if now != 0.0:
            share = now / p.severity
            x.stiffness_scale *= 1.0 + share * p.effects.stiffness
            x.lateral_scale *= 1.0 + share * p.effects.lateral
            x.lateral_reach *= 1.0 + share * p.effects.lateral_reach
            x.rotation_scale *= 1.0 + share * p.effects.rotation
            x.rotation_reach *= 1.0 + share * p.effects.rotation_reach
            x.cubic += share * p.effects.cubic
            x.sideways += share * p.effects.sideways
            x.turn += share * p.effects.turn
            x.turn_cubic += share * p.effects.turn_cubic
