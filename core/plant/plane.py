"""Parameters of the plant in the plane, and where they stand when packed."""

from __future__ import annotations

import math
from dataclasses import asdict

from core.block import Context, parameter
from core.device.geometry import drawn
from core.device.lateral import lateral
from core.noise import key
from core.plant.contact import PLANT, ContactParams, resolved_us
from core.units import UN_PER_N, thermal_force_un

(
    STRENGTH,
    GAP_SQUARED,
    PER_GAP,
    STATOR,
    ROTOR,
    PER_INERTIA,
    SIDE_DAMPING,
    TURN_DAMPING,
    SQUEEZE,
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
) = range(PLANT, PLANT + 26)


class PlaneParams(ContactParams):
    """Mechanics across the drive; what is not given follows from the drawing of the device.

    A device without a drawing is given that of LCR-350 with its own comb.
    """

    stator_tip_um: float | None = parameter(
        None, "distance of the stator's finger tips from the centre; from the drawing unless given", "um", gt=0
    )
    overlap_um: float | None = parameter(
        None, "finger overlap at rest; from the drawing unless given", "um", gt=20.0, le=1000
    )
    inertia_kg_m2: float | None = parameter(
        None, "rotary inertia; from the drawing unless given", "kg m^2", gt=1e-21, le=1e-9
    )
    lateral_stiffness_n_m: float | None = parameter(
        None, "stiffness along y at rest; from the drawing unless given", "N/m", gt=0, le=1e4
    )
    lateral_reach_um: float | None = parameter(
        None, "travel that halves the stiffness along y; from the drawing unless given", "um", gt=0.1, le=1e9
    )
    rotation_stiffness_nm: float | None = parameter(
        None, "stiffness against rotation at rest; from the drawing unless given", "N m/rad", gt=0, le=1e-4
    )
    rotation_reach_um: float | None = parameter(
        None, "travel that halves the stiffness against rotation; from the drawing unless given", "um", gt=0.1, le=1e9
    )
    cubic_n_m3: float = parameter(0.0, "cubic stiffness along x", "N/m^3", ge=-1e10, le=1e12)
    sideways_per_m: float = parameter(0.0, "sideways shift per squared travel", "1/m", ge=-1e5, le=1e5)
    turn_rad_m: float = parameter(0.0, "rotation per travel", "rad/m", ge=-1e4, le=1e4)
    turn_cubic_rad_m3: float = parameter(0.0, "rotation per cubed travel", "rad/m^3", ge=-1e13, le=1e13)
    misalignment_um: float = parameter(0.0, "sideways offset of the combs as made", "um", ge=-0.5, le=0.5)
    misalignment_mrad: float = parameter(0.0, "rotation of the combs as made", "mrad", ge=-3, le=3)
    lateral_damping_ns_m: float | None = parameter(
        None, "damping along y without the fingers; from the drawing unless given", "N s/m", ge=0, le=1e-3
    )
    rotation_damping_nms: float | None = parameter(
        None, "damping of the rotation without the fingers; from the drawing unless given", "N m s", ge=0, le=1e-9
    )
    squeeze_ns_m: float | None = parameter(
        None,
        "squeeze film of all fingers at the centre, of a continuous gas; from the drawing unless given",
        "N s/m",
        ge=0,
        le=1e-4,
    )
    step_us: float = parameter(0.25, "longest substep", "us", gt=0.01, le=1.0)
    near_step_us: float = parameter(0.1, "longest substep beyond 0.4 of the gap", "us", gt=0.01, le=0.25)

    def packed(self, context: Context) -> list[float]:
        """Pack what the plant in the plane has beyond what all plants share: uN um is 1e12 N m, and so on."""
        known = asdict(lateral(drawn(context)))
        gap = known.pop("gap_um")
        own = {name: known[name] if getattr(self, name) is None else getattr(self, name) for name in known}
        mass = context.device.mass
        step = self.stop_step_us(self.step_us, mass)
        coarse = math.ceil(context.dt_ms * 1e3 / step - 1e-9)
        # all corners may touch at once, which moves the shuttle or turns it
        stator, rotor = own["stator_tip_um"], own["stator_tip_um"] + own["overlap_um"]
        inertia = own["inertia_kg_m2"] * 1e18
        touching = min(0.25 * mass, 0.5 * inertia / (stator * stator + rotor * rotor))
        near = resolved_us(self.near_step_us, self.contact_stiffness_n_m, self.contact_damping_ns_m * 1e3, touching)
        fine = max(1, math.ceil(context.dt_ms * 1e3 / coarse / near - 1e-9))
        noisy = 1.0 if self.thermal_noise else 0.0
        return [
            *super().packed(context),
            0.5 * context.capacitance_gradient * UN_PER_N * gap * gap,
            gap * gap,
            1.0 / gap,
            stator,
            rotor,
            1e-18 / own["inertia_kg_m2"],
            own["lateral_damping_ns_m"] * 1e3,
            own["rotation_damping_nms"] * 1e15,
            0.5 * own["squeeze_ns_m"] * 1e3,
            self.misalignment_um,
            self.misalignment_mrad * 1e-3,
            self.cubic_n_m3 * 1e-12,
            own["lateral_stiffness_n_m"],
            own["lateral_reach_um"],
            own["rotation_stiffness_nm"] * 1e12,
            own["rotation_reach_um"],
            self.sideways_per_m * 1e-6,
            self.turn_rad_m * 1e-6,
            self.turn_cubic_rad_m3 * 1e-18,
            float(coarse),
            float(fine),
            0.4 * gap,
            noisy * thermal_force_un(context.temperature_k, context.dt_ms / coarse),
            noisy * thermal_force_un(context.temperature_k, context.dt_ms / coarse / fine),
            key(context.seed, "plant.thermal.side"),
            key(context.seed, "plant.thermal.turn"),
        ]
