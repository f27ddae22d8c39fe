"""What faults of the suspension share: their effect on the whole of its elasticity.

The part that is linear in the displacement comes from a frame of beams with the drawing of the device; what bends with
the travel was fitted to the frame of LCR-350 at large displacements, for the named places.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from core.block import FloatArray, Port
from core.device.frame import Damage, along_x, stiffness
from core.device.geometry import Geometry
from core.faults.fault import SEVERITY, channels, severity_at

OWN = 5
"""Where the effects begin in the packed parameters, after severity and profile."""

STRUCTURE: tuple[Port, ...] = channels(
    "stiffness_scale",
    "lateral_scale",
    "lateral_reach",
    "rotation_scale",
    "rotation_reach",
    "cubic",
    "sideways",
    "turn",
    "turn_cubic",
)
"""Five scales, then four sums."""


@dataclass(frozen=True)
class Bending:
    """What grows with the travel: reaches over nominal, then cubic N/m^3, sideways 1/m, turn rad/m^3."""

    reach_y: float = 1.0
    reach_t: float = 1.0
    cubic: float = 0.0
    sideways: float = 0.0
    turn_cubic: float = 0.0

    def scaled(self, factor: float) -> Bending:
        """Return a share of it."""
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
    # the turn that costs nothing at a travel, with the shuttle free sideways
    coupling = hurt[2, 0] - hurt[2, 1] * hurt[1, 0] / hurt[1, 1]
    turning = hurt[2, 2] - hurt[2, 1] * hurt[1, 2] / hurt[1, 1]
    return (
        along_x(hurt) / along_x(whole),
        float(hurt[1, 1] / whole[1, 1]),
        float(hurt[2, 2] / whole[2, 2]),
        float(-coupling / turning),
    )


def effects(geometry: Geometry, damage: Damage, bending: Bending) -> list[float]:
    """Return what the whole fault does to each channel: added shares for scales, the sums themselves."""
    along, sideways, turning, turn = linear(geometry, damage)
    return [
        along - 1.0,
        sideways - 1.0,
        bending.reach_y - 1.0,
        turning - 1.0,
        bending.reach_t - 1.0,
        bending.cubic * 1e-12,
        bending.sideways * 1e-6,
        turn,
        bending.turn_cubic * 1e-18,
    ]


def packed(common: FloatArray, share: float, whole: list[float]) -> list[float]:
    """Return severity and profile with the effects at full severity behind them."""
    return [*common.tolist(), *(share * value for value in whole)]


def structure_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Change the suspension by the share of the severity that is there now."""
    severity = severity_at(p, w[0])
    w[io[9]] = severity
    if severity != 0.0:
        share = severity / p[SEVERITY]
        for i in range(5):
            w[io[i]] *= 1.0 + share * p[OWN + i]
        for i in range(5, 9):
            w[io[i]] += share * p[OWN + i]
