"""Fingers that touch a stator and a shuttle that reaches its stops: what plants with a lateral motion share."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, kernel, parameter
from core.device.geometry import drawn
from core.plant.shuttle import OWN, ShuttleParams, wall

(
    GAP,
    LIMIT,
    TOUCH,
    TOUCH_STIFFNESS,
    TOUCH_DAMPING,
    SHORTS,
    STOP,
    STOP_STIFFNESS,
    STOP_DAMPING,
    PLANT,
) = range(OWN, OWN + 10)
"""Packed parameters behind those of every plant; a plant's own start at ``PLANT``."""
LEAST_US = 0.01
"""Shortest step, so that a sample ends."""


class ContactParams(ShuttleParams):
    """What happens where the shuttle touches."""

    contact_clearance_um: float = parameter(0.15, "gap that is left where fingers touch", "um", gt=0, le=0.2)
    contact_stiffness_n_m: float = parameter(5e3, "stiffness of touching fingers", "N/m", ge=0, le=1e4)
    contact_damping_ns_m: float = parameter(1.5e-5, "damping of touching fingers", "N s/m", ge=0, le=1e-4)
    short_on_contact: bool = parameter(True, "touching fingers short their comb")
    stop_um: float = parameter(20.0, "travel to the end stops", "um", gt=0, le=25)
    stop_stiffness_n_m: float = parameter(50.0, "stiffness of a stop", "N/m", ge=0, le=5e3)
    stop_damping_ns_m: float = parameter(2e-5, "damping of a stop", "N s/m", ge=0, le=1e-4)

    def stop_step_us(self, step_us: float, mass: float) -> float:
        """Return the longest step asked for, or the longest that follows the end stops."""
        return resolved_us(step_us, self.stop_stiffness_n_m, self.stop_damping_ns_m * 1e3, mass)

    def packed(self, context: Context) -> list[float]:
        """Pack gap, contact and stops; the force law holds up to nine tenths of the gap."""
        gap = drawn(context).gap_um
        return [
            gap,
            0.9 * gap,
            gap - self.contact_clearance_um,
            self.contact_stiffness_n_m,
            self.contact_damping_ns_m * 1e3,
            float(self.short_on_contact),
            self.stop_um,
            self.stop_stiffness_n_m,
            self.stop_damping_ns_m * 1e3,
        ]


def resolved_us(step_us: float, stiffness: float, damping: float, mass: float) -> float:
    """Return the longest step asked for, or one over the rates of a wall: Runge-Kutta is unstable beyond 2.8 of it."""
    rate = max(math.sqrt(stiffness / mass), damping / mass)
    return max(min(step_us, 1e3 / rate), LEAST_US) if rate > 0.0 else step_us


@kernel
def touch(p: Any, eta: float, rate: float) -> float:
    """Return the force of a stator on fingers that are ``eta`` off their centre, uN."""
    return wall(p[TOUCH], p[TOUCH_STIFFNESS], p[TOUCH_DAMPING], eta, rate)


@kernel
def stop(p: Any, x: float, v: float) -> float:
    """Return the force of the end stops, uN."""
    return wall(p[STOP], p[STOP_STIFFNESS], p[STOP_DAMPING], x, v)
