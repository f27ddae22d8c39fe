"""Parameters, packed numbers, state and ports of the plant in the plane."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from core.block import Context, parameter
from core.device.geometry import drawn
from core.device.lateral import lateral
from core.plant.contact import ContactParams, TouchingShuttle, resolved_us
from core.plant.shuttle import ELASTICITY
from core.plant.suspension import Suspension
from core.ports import reads
from core.record import Record, stream
from core.units import UN_PER_N, thermal_force_un


class PlaneParams(ContactParams):
    """Mechanics across the drive; missing values follow from the drawing of the device.

    A device without a drawing gets the drawing of LCR-350 with its own comb.
    """

    stator_tip_um: float | None = parameter(
        None, "distance of the stator's finger tips from the centre; from the drawing unless given", "um", gt=0
    )
    overlap_um: float | None = parameter(
        None, "undeflected finger overlap; from the drawing unless given", "um", gt=20.0, le=1000
    )
    inertia_kg_m2: float | None = parameter(
        None, "rotary inertia; from the drawing unless given", "kg m^2", gt=1e-21, le=1e-9
    )
    lateral_stiffness_n_m: float | None = parameter(
        None, "stiffness along y without travel; from the drawing unless given", "N/m", gt=0, le=1e4
    )
    lateral_reach_um: float | None = parameter(
        None, "travel that halves the stiffness along y; from the drawing unless given", "um", gt=0.1, le=1e9
    )
    rotation_stiffness_nm: float | None = parameter(
        None, "stiffness against rotation without travel; from the drawing unless given", "N m/rad", gt=0, le=1e-4
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


class Plane(TouchingShuttle):
    """A rigid shuttle in the plane."""

    class Packed(TouchingShuttle.Packed):
        """Comb, inertia, dampings and suspension; substeps of a sample, and noise of each."""

        strength: float
        gap_squared: float
        per_gap: float
        stator_tip: float
        rotor_tip: float
        per_inertia: float
        lateral_damping: float
        rotation_damping: float
        squeeze: float
        misalignment_um: float
        misalignment_rad: float
        cubic: float
        lateral_stiffness: float
        lateral_reach: float
        rotation_stiffness: float
        rotation_reach: float
        sideways: float
        turn: float
        turn_cubic: float
        coarse_steps: float
        fine_steps: float
        near_um: float
        thermal_coarse: float
        thermal_fine: float
        side_key: float = stream("plant.thermal.side")
        turn_key: float = stream("plant.thermal.turn")

    class State(Record):
        """Suspension of this sample, one over its mass, dampings, outer forces; time of the first contact."""

        suspension: Suspension
        per_mass: float
        damping: float
        lateral_damping: float
        rotation_damping: float
        squeeze: float
        force_x: float
        force_y: float
        touched_ms: float

    class Ports(TouchingShuttle.Ports):
        """Effects that change its suspension and its squeeze film, and its sideways acceleration."""

        acceleration_side: float = reads("effects.acceleration_side", "um/ms^2", "acceleration of the frame along y")
        cubic: float = reads("effects.cubic", "uN/um^3", "added cubic stiffness")
        lateral_scale: float = reads("effects.lateral_scale", "1", "stiffness along y over nominal")
        lateral_reach: float = reads("effects.lateral_reach", "1", "reach of the stiffness along y over nominal")
        rotation_scale: float = reads("effects.rotation_scale", "1", "stiffness against rotation over nominal")
        rotation_reach: float = reads("effects.rotation_reach", "1", "reach of the same over nominal")
        sideways: float = reads("effects.sideways", "1/um", "added sideways shift per squared travel")
        turn: float = reads("effects.turn", "rad/um", "added rotation per travel")
        turn_cubic: float = reads("effects.turn_cubic", "rad/um^3", "added rotation per cubed travel")
        squeeze_scale: float = reads("effects.squeeze_scale", "1", "squeeze film over continuous, over the damping")
        elasticity_scale: float = ELASTICITY

    @classmethod
    def pack(cls, params: Any, context: Context) -> Any:
        """Pack the numbers of the plant in the plane that other plants do not have: uN um is 1e12 N m, and so on."""
        known = asdict(lateral(drawn(context)))
        gap = known.pop("gap_um")
        given = {name: known[name] if getattr(params, name) is None else getattr(params, name) for name in known}
        mass = context.device.mass
        step = params.stop_step_us(params.step_us, mass)
        coarse = math.ceil(context.dt_ms * 1e3 / step - 1e-9)
        # all corners may touch at once and move or turn the shuttle
        stator, rotor = given["stator_tip_um"], given["stator_tip_um"] + given["overlap_um"]
        inertia = given["inertia_kg_m2"] * 1e18
        touching = min(0.25 * mass, 0.5 * inertia / (stator * stator + rotor * rotor))
        near = resolved_us(
            params.near_step_us, params.contact_stiffness_n_m, params.contact_damping_ns_m * 1e3, touching
        )
        fine = max(1, math.ceil(context.dt_ms * 1e3 / coarse / near - 1e-9))
        noisy = 1.0 if params.thermal_noise else 0.0
        p: Any = super().pack(params, context)
        p.strength = 0.5 * context.capacitance_gradient * UN_PER_N * gap * gap
        p.gap_squared = gap * gap
        p.per_gap = 1.0 / gap
        p.stator_tip = stator
        p.rotor_tip = rotor
        p.per_inertia = 1e-18 / given["inertia_kg_m2"]
        p.lateral_damping = given["lateral_damping_ns_m"] * 1e3
        p.rotation_damping = given["rotation_damping_nms"] * 1e15
        p.squeeze = 0.5 * given["squeeze_ns_m"] * 1e3
        p.misalignment_rad = params.misalignment_mrad * 1e-3
        p.cubic = params.cubic_n_m3 * 1e-12
        p.lateral_stiffness = given["lateral_stiffness_n_m"]
        p.lateral_reach = given["lateral_reach_um"]
        p.rotation_stiffness = given["rotation_stiffness_nm"] * 1e12
        p.rotation_reach = given["rotation_reach_um"]
        p.sideways = params.sideways_per_m * 1e-6
        p.turn = params.turn_rad_m * 1e-6
        p.turn_cubic = params.turn_cubic_rad_m3 * 1e-18
        p.coarse_steps = float(coarse)
        p.fine_steps = float(fine)
        p.near_um = 0.4 * gap
        p.thermal_coarse = noisy * thermal_force_un(context.temperature_k, context.dt_ms / coarse)
        p.thermal_fine = noisy * thermal_force_un(context.temperature_k, context.dt_ms / coarse / fine)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Return room for the suspension and forces of a sample, and the time of the first contact."""
        s = cls.State.zeros()
        s.touched_ms = -1.0
        return s
