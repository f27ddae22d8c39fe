"""Parameters of the plant in the plane, and where they stand when packed."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, parameter
from core.noise import key
from core.plant.shuttle import OWN, ShuttleParams
from core.plant.suspension import HEALTHY
from core.units import thermal_force_un

(
    STRENGTH,
    GAP_SQUARED,
    PER_GAP,
    LIMIT,
    STATOR,
    ROTOR,
    PER_INERTIA,
    SIDE_DAMPING,
    TURN_DAMPING,
    SQUEEZE,
    TOUCH,
    TOUCH_STIFFNESS,
    TOUCH_DAMPING,
    SHORTS,
    STOP,
    STOP_STIFFNESS,
    STOP_DAMPING,
    Y_MISS,
    T_MISS,
    CUBIC,
    SIDE_STIFFNESS,
    SIDE_REACH,
    TURN_STIFFNESS,
    TURN_REACH,
    SIDEWAYS,
    TURN,
    TURN_CUBIC,
    COARSE,
    FINE,
    NEAR,
    THERMAL_COARSE,
    THERMAL_FINE,
    SIDE_KEY,
    TURN_KEY,
) = range(OWN, OWN + 34)


class PlaneParams(ShuttleParams):
    """Lateral mechanics; the defaults are those of the device LCR-350, x comes from the device."""

    gap_um: float = parameter(2.1, "gap between fingers as etched", "um", gt=0.2, le=100)
    stator_tip_um: float = parameter(126.13, "distance of the stator's finger tips from the centre", "um", gt=0)
    overlap_um: float = parameter(40.0, "finger overlap at rest", "um", gt=20.0, le=1000)
    inertia_kg_m2: float = parameter(9.573e-18, "rotary inertia", "kg m^2", gt=1e-21)
    lateral_stiffness_n_m: float = parameter(HEALTHY.ky, "stiffness along y at rest", "N/m", gt=0, le=1e4)
    lateral_reach_um: float = parameter(HEALTHY.reach_y, "travel that halves the stiffness along y", "um", gt=0.1)
    rotation_stiffness_nm: float = parameter(HEALTHY.kt, "stiffness against rotation at rest", "N m/rad", gt=0, le=1e-4)
    rotation_reach_um: float = parameter(
        HEALTHY.reach_t, "travel that halves the stiffness against rotation", "um", gt=0.1
    )
    cubic_n_m3: float = parameter(HEALTHY.k3, "cubic stiffness along x", "N/m^3", ge=-1e10, le=1e12)
    sideways_per_m: float = parameter(HEALTHY.ys2, "sideways shift per squared travel", "1/m", ge=-1e5, le=1e5)
    turn_rad_m: float = parameter(HEALTHY.th1, "rotation per travel", "rad/m", ge=-1e4, le=1e4)
    turn_cubic_rad_m3: float = parameter(HEALTHY.th3, "rotation per cubed travel", "rad/m^3", ge=-1e13, le=1e13)
    misalignment_um: float = parameter(0.0, "sideways offset of the combs as made", "um", ge=-0.5, le=0.5)
    misalignment_mrad: float = parameter(0.0, "rotation of the combs as made", "mrad", ge=-3, le=3)
    lateral_damping_ns_m: float = parameter(4.57e-7, "damping along y without the fingers", "N s/m", ge=0, le=1e-3)
    rotation_damping_nms: float = parameter(
        2.90e-14, "damping of the rotation without the fingers", "N m s", ge=0, le=1e-9
    )
    squeeze_ns_m: float = parameter(2.22e-7, "squeeze film of all fingers at the centre", "N s/m", ge=0, le=1e-4)
    contact_clearance_um: float = parameter(0.15, "gap that is left where fingers touch", "um", gt=0, le=0.2)
    contact_stiffness_n_m: float = parameter(5e3, "stiffness of a touching corner", "N/m", ge=0, le=1e4)
    contact_damping_ns_m: float = parameter(1.5e-5, "damping of a touching corner", "N s/m", ge=0, le=1e-4)
    short_on_contact: bool = parameter(True, "touching fingers short their comb")
    stop_um: float = parameter(20.0, "travel to the end stops", "um", gt=0, le=25)
    stop_stiffness_n_m: float = parameter(50.0, "stiffness of a stop", "N/m", ge=0, le=5e3)
    stop_damping_ns_m: float = parameter(2e-5, "damping of a stop", "N s/m", ge=0, le=1e-4)
    step_us: float = parameter(0.25, "longest substep", "us", gt=0.01, le=1.0)
    near_step_us: float = parameter(0.1, "longest substep beyond 0.4 of the gap", "us", gt=0.01, le=0.25)


def packed(params: Any, context: Context) -> list[float]:
    """Pack what the plant in the plane has beyond what all plants share: uN um is 1e12 N m, and so on."""
    gap = params.gap_um
    coarse = math.ceil(context.dt_ms * 1e3 / params.step_us - 1e-9)
    fine = max(1, math.ceil(context.dt_ms * 1e3 / coarse / params.near_step_us - 1e-9))
    noisy = 1.0 if params.thermal_noise else 0.0
    return [
        0.5 * context.capacitance_gradient * 1e6 * gap * gap,
        gap * gap,
        1.0 / gap,
        0.9 * gap,
        params.stator_tip_um,
        params.stator_tip_um + params.overlap_um,
        1e-18 / params.inertia_kg_m2,
        params.lateral_damping_ns_m * 1e3,
        params.rotation_damping_nms * 1e15,
        0.5 * params.squeeze_ns_m * 1e3,
        gap - params.contact_clearance_um,
        params.contact_stiffness_n_m,
        params.contact_damping_ns_m * 1e3,
        float(params.short_on_contact),
        params.stop_um,
        params.stop_stiffness_n_m,
        params.stop_damping_ns_m * 1e3,
        params.misalignment_um,
        params.misalignment_mrad * 1e-3,
        params.cubic_n_m3 * 1e-12,
        params.lateral_stiffness_n_m,
        params.lateral_reach_um,
        params.rotation_stiffness_nm * 1e12,
        params.rotation_reach_um,
        params.sideways_per_m * 1e-6,
        params.turn_rad_m * 1e-6,
        params.turn_cubic_rad_m3 * 1e-18,
        float(coarse),
        float(fine),
        0.4 * gap,
        noisy * thermal_force_un(context.temperature_k, context.dt_ms / coarse),
        noisy * thermal_force_un(context.temperature_k, context.dt_ms / coarse / fine),
        key(context.seed, "plant.thermal.side"),
        key(context.seed, "plant.thermal.turn"),
    ]
