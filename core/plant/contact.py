"""Contact of fingers with a stator and of the shuttle with its stops, for plants with a lateral motion."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, parameter
from core.device.geometry import drawn
from core.kernel import kernel
from core.plant.shuttle import Shuttle, ShuttleParams, wall

LEAST_US = 0.01
"""Shortest step, so that a sample takes a finite number of them."""


class ContactParams(ShuttleParams):
    """The contact of fingers with a stator, and the stops of the shuttle."""

    contact_clearance_um: float = parameter(0.15, "gap that is left where fingers touch", "um", gt=0, le=0.2)
    contact_stiffness_n_m: float = parameter(5e3, "stiffness of touching fingers", "N/m", ge=0, le=1e4)
    contact_damping_ns_m: float = parameter(1.5e-5, "damping of touching fingers", "N s/m", ge=0, le=1e-4)
    short_on_contact: bool = parameter(True, "touching fingers short their comb")
    stop_um: float = parameter(20.0, "travel to the end stops", "um", gt=0, le=25)
    stop_stiffness_n_m: float = parameter(50.0, "stiffness of a stop", "N/m", ge=0, le=5e3)
    stop_damping_ns_m: float = parameter(2e-5, "damping of a stop", "N s/m", ge=0, le=1e-4)

    def stop_step_us(self, step_us: float, mass: float) -> float:
        """Return the longest step given, or a shorter one if the end stops need it."""
        return resolved_us(step_us, self.stop_stiffness_n_m, self.stop_damping_ns_m * 1e3, mass)


class TouchingShuttle(Shuttle):
    """A plant whose fingers may touch a stator."""

    class Packed(Shuttle.Packed):
        """Gap, largest offset at which the force law holds, offset at which fingers touch; contact and stops."""

        gap: float
        limit: float
        touch_um: float
        contact_stiffness_n_m: float
        contact_damping: float
        short_on_contact: float
        stop_um: float
        stop_stiffness_n_m: float
        stop_damping: float

    @classmethod
    def pack(cls, params: Any, context: Context) -> Any:
        """Pack gap, contact and stops; the force law holds up to nine tenths of the gap."""
        gap = drawn(context).gap_um
        p: Any = super().pack(params, context)
        p.gap = gap
        p.limit = 0.9 * gap
        p.touch_um = gap - params.contact_clearance_um
        p.contact_damping = params.contact_damping_ns_m * 1e3
        p.stop_damping = params.stop_damping_ns_m * 1e3
        return p


def resolved_us(step_us: float, stiffness: float, damping: float, mass: float) -> float:
    """Return the longest step given, or one over the rates of a wall: Runge-Kutta is unstable beyond 2.8 of it."""
    rate = max(math.sqrt(stiffness / mass), damping / mass)
    return max(min(step_us, 1e3 / rate), LEAST_US) if rate > 0.0 else step_us


@kernel
def touch(p: TouchingShuttle.Packed, eta: float, rate: float) -> float:
    """Return the force of a stator on fingers at the offset ``eta`` from their centre, uN."""
    return wall(p.touch_um, p.contact_stiffness_n_m, p.contact_damping, eta, rate)


@kernel
def stop(p: TouchingShuttle.Packed, x: float, v: float) -> float:
    """Return the force of the end stops, uN."""
    return wall(p.stop_um, p.stop_stiffness_n_m, p.stop_damping, x, v)
