r"""A gyroscope drawn with the parts of a comb resonator: its beams, its fingers, its plate."""

from __future__ import annotations

import math

from pydantic import ValidationError

from core.block import BlockParams, parameter
from core.device.environment import (
    ATMOSPHERE_PA,
    ROOM_K,
    damping_scale,
    penetration_depth_um,
    structural_share,
    viscosity,
)
from core.device.geometry import Geometry
from core.device.gyroscope import GyroscopeTable
from core.device.ranges import Fingers, LengthUm
from core.errors import from_validation
from core.units import FF_PER_F, UM_PER_M

FLEXURES = 2
"""Flexures of each axis: one to the ground, one between the proof mass and the frame of the other axis."""


class DrawnGyroscope(BlockParams):
    r"""Data of a gyroscope in addition to the drawing of a comb resonator, which gives all the rest.

    The folded flexure of a comb resonator yields along x alone: along y the flexure of LCR-350 has 205 N/m, against
    0.054. A comb that moves across its fingers closes their gaps besides. So there are two frames. The plate is the
    proof mass, and moves along both axes. The arms and fingers of the drawing are the drive frame, which moves along x;
    a second set of arms and fingers is the sense frame, which moves along y. A flexure like the drawn flexure holds the
    drive frame to the ground, a second flexure lets the proof mass move along x in the sense frame; two flexures with
    beams of their own do the same along y:

    .. math:: k_x=2k(L,w),\quad k_y=2k(L_y,w_y)\qquad\text{with }k\text{ of 1.3.4}

    .. math:: m_x=m_p+m_{fx}+2\left(\tfrac{12}{35}m_{bx}+\tfrac14m_{tx}\right)+m_{by}+m_{ty},\quad
        m_c=m_p+\tfrac12(m_{bx}+m_{tx}+m_{by}+m_{ty})

    and :math:`m_y` with x and y exchanged. Shares of a flexure that bends are given by 1.3.3; the flexure between a
    frame that moves and the proof mass is carried along whole. The rate acts on the mass that moves along both axes,
    :math:`m_c=\int\phi_x\phi_y\,dm`, where the mean motion of a flexure that bends is one half.

    Gas: 1.3.7 along each axis, scaled to the pressure of the package like the gas of a resonator, structural loss
    included. The package is sealed: pressure and temperature around it do not change the damping.

    A drawing does not contain the fabrication errors: the angles are parameters, and so is the pressure.
    """

    sense_beam_length_um: LengthUm = parameter(340.0, "length of the beams that bend along y", "um", live=False)
    sense_beam_width_um: LengthUm = parameter(2.0, "width of the beams that bend along y, as drawn", "um", live=False)
    sense_fingers: Fingers = parameter(87, "rotor fingers per side along y", live=False)
    package_pa: float = parameter(100.0, "pressure in the package; assumed", "Pa", ge=0.01, le=1e6, live=False)
    alpha_deg: float = parameter(
        0.0,
        "angle of the axes of stiffness; of making, not of drawing",
        "deg",
        ge=-90,
        le=90,
        equation="6.1.3",
        live=False,
    )
    gamma_deg: float = parameter(
        0.0,
        "angle of the axes of damping; of making, not of drawing",
        "deg",
        ge=-90,
        le=90,
        equation="6.1.3",
        live=False,
    )
    drive_amplitude_um: LengthUm = parameter(5.0, "amplitude x is meant to swing with", "um", live=False)

    def sense(self, drawing: Geometry) -> Geometry:
        """Return the drawing with the beams and fingers of y.

        Raises
        ------
        ValueError
            If nothing is left of the beams.
        """
        along_y = {
            "beam_length_um": self.sense_beam_length_um,
            "beam_width_um": self.sense_beam_width_um,
            "fingers": self.sense_fingers,
        }
        try:
            return Geometry.model_validate({**drawing.model_dump(), **along_y})
        except ValidationError as error:
            raise ValueError(f"along y {from_validation(error)}") from None

    def table(self, drawing: Geometry) -> GyroscopeTable:
        """Return masses, stiffness and damping of both axes.

        Raises
        ------
        ValueError
            For parts that do not fit together, or a device out of range.
        """
        sense = self.sense(drawing)
        self._refuse_what_does_not_fit(drawing, sense)
        masses = [moving_mass_kg(drawing, sense), moving_mass_kg(sense, drawing)]
        stiffness = [FLEXURES * each.stiffness_n_m() for each in (drawing, sense)]
        damping = [
            damping_ns_m(bent, carried, mass, spring, self.package_pa)
            for bent, carried, mass, spring in zip((drawing, sense), (sense, drawing), masses, stiffness, strict=True)
        ]
        try:
            return GyroscopeTable(
                mass_x_kg=masses[0],
                mass_y_kg=masses[1],
                coriolis_mass_kg=coriolis_mass_kg(drawing, sense),
                stiffness_x_n_m=stiffness[0],
                stiffness_y_n_m=stiffness[1],
                damping_x_ns_m=damping[0],
                damping_y_ns_m=damping[1],
                alpha_deg=self.alpha_deg,
                gamma_deg=self.gamma_deg,
                drive_amplitude_um=self.drive_amplitude_um,
            )
        except ValidationError as error:
            raise ValueError(f"the drawing gives a gyroscope that cannot be: {from_validation(error)}") from None

    def metrics(self, drawing: Geometry, stiffness_scale: float, scale_pm_per_dps: float) -> dict[str, float]:
        r"""Return the figures of the drawing beyond the figures of every gyroscope.

        A comb pulls with :math:`F=4n\varepsilon_0\frac tgV_bv` (1.3.2), and the difference of its two sides changes by
        :math:`\frac{dC}{dy}=4n\varepsilon_0\frac tg`: nN/V^2 and fF/um are the same number.

        Parameters
        ----------
        drawing : Geometry
            The drawing.
        stiffness_scale : float
            Stiffness in the environment, over nominal.
        scale_pm_per_dps : float
            Scale factor in the open loop.
        """
        table, sense = self.table(drawing), self.sense(drawing)
        drive_ff, sense_ff = (2.0 * each.capacitance_gradient() * FF_PER_F / UM_PER_M for each in (drawing, sense))
        return {
            "gyro.mass_x_kg": table.mass_x_kg,
            "gyro.mass_y_kg": table.mass_y_kg or table.mass_x_kg,
            "gyro.coriolis_mass_kg": table.coriolis_mass_kg or table.mass_x_kg,
            "gyro.stiffness_x_n_m": stiffness_scale * table.stiffness_x_n_m,
            "gyro.stiffness_y_n_m": stiffness_scale * table.stiffness_y_n_m,
            "gyro.force_x_nn_per_v2": drive_ff,
            "gyro.force_y_nn_per_v2": sense_ff,
            "gyro.sense_ff_per_um": sense_ff,
            "gyro.sense_af_per_dps": 1e-3 * sense_ff * scale_pm_per_dps,
        }

    def _refuse_what_does_not_fit(self, drawing: Geometry, sense: Geometry) -> None:
        if plate_um2(drawing) <= 0.0:
            raise ValueError("nothing is left of the proof mass: openings_um2 is more than the plate")
        for axis, each in (("x", drawing), ("y", sense)):
            taken = 2.0 * each.far_finger_um + each.finger_width_um
            if taken > each.arm_length_um:
                raise ValueError(
                    f"{each.fingers} fingers along {axis} take {taken:g} um of an arm of {each.arm_length_um:g} um"
                )
        reach = min(drawing.overlap_um, drawing.finger_length_um - drawing.overlap_um)
        if self.drive_amplitude_um >= reach:
            raise ValueError(
                f"x swings out of its fingers or into their stators: drive_amplitude_um must be below {reach:g}"
            )


def plate_um2(drawing: Geometry) -> float:
    """Return the plan area of the plate, which is the proof mass."""
    return drawing.plate_length_um * drawing.plate_width_um - drawing.openings_um2


def moving_mass_kg(bent: Geometry, carried: Geometry) -> float:
    """Return the mass that moves along an axis: two flexures bend, and one of the other axis is carried along."""
    shuttle, beams, trusses, _ = bent.areas_um2
    _, other_beams, other_trusses, _ = carried.areas_um2
    area = shuttle + FLEXURES * (12.0 * beams / 35.0 + trusses / 4.0) + other_beams + other_trusses
    return per_area_kg(bent) * area


def coriolis_mass_kg(drawing: Geometry, sense: Geometry) -> float:
    """Return the mass that moves along both axes, each part by the product of its shares."""
    flexures = sum(each.areas_um2[1] + each.areas_um2[2] for each in (drawing, sense))
    return per_area_kg(drawing) * (plate_um2(drawing) + 0.5 * flexures)


def damping_ns_m(bent: Geometry, carried: Geometry, mass_kg: float, stiffness_n_m: float, package_pa: float) -> float:
    """Return the damping along an axis in a package: 1.3.7 at 1 atm, brought to its pressure as for a resonator."""
    shuttle, beams, trusses, combs = bent.areas_um2
    _, other_beams, other_trusses, _ = carried.areas_um2
    plan = shuttle + FLEXURES * (beams + trusses) / 2.0 + other_beams + other_trusses
    film, gap = bent.film_gap_um, bent.gap_um
    omega = math.sqrt(stiffness_n_m / mass_kg)
    depth = penetration_depth_um(ATMOSPHERE_PA, ROOM_K, omega)
    open_air = viscosity(ROOM_K) * 1e-6 * (plan * (1.0 / film + 1.0 / depth) + combs / gap)
    structural = structural_share(mass_kg * omega / open_air)
    return float(open_air * damping_scale(package_pa, ROOM_K, plan, film, combs, gap, omega, structural))


def per_area_kg(drawing: Geometry) -> float:
    """Return the mass of a layer, kg/um^2."""
    return drawing.density_kg_m3 * drawing.thickness_um * 1e-18
