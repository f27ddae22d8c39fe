r"""Mass, stiffness and damping of a folded-flexure comb resonator from its drawing.

Equations 1.3.3, 1.3.4 and 1.3.7 of the dissertation, as corrected: the gas film under the plate and the
structural thickness share one printed symbol and are two numbers here (``film_gap_um``, ``thickness_um``);
1.3.4 is the stiffness of the whole suspension, with the truss length taken between adjacent beams; a whole truss has
three such segments, all alike.
"""

from __future__ import annotations

from typing import Self

import numpy as np
from pydantic import model_validator

from core.block import BlockParams, Context, parameter
from core.device.environment import ATMOSPHERE_PA, ROOM_K, penetration_depth_um, viscosity
from core.device.ranges import EtchUm, Fingers, LengthUm, PartUm
from core.units import EPSILON_0


class Geometry(BlockParams):
    """A drawing: lengths in um, widths as drawn, with the etch bias per edge as a field of its own.

    The formulas hold for arrays too: ``core.device.spread`` puts whole wafers through them.
    """

    thickness_um: LengthUm = parameter(2.0, "structural thickness", "um", live=False)
    film_gap_um: LengthUm = parameter(2.0033, "gas film under the plate", "um", live=False)
    beam_length_um: LengthUm = parameter(350.0, "length of a flexure beam", "um", live=False)
    beam_width_um: LengthUm = parameter(2.0, "width of a beam as drawn", "um", live=False)
    beam_bias_um: EtchUm = parameter(0.2384, "etch bias per edge of beams and trusses", "um", live=False)
    truss_width_um: LengthUm = parameter(4.0, "width of a truss as drawn", "um", live=False)
    truss_segment_um: LengthUm = parameter(30.0, "truss length between adjacent beams", "um", live=False)
    fingers: Fingers = parameter(87, "rotor fingers per side", live=False)
    finger_length_um: LengthUm = parameter(60.0, "finger length", "um", live=False)
    finger_width_um: LengthUm = parameter(2.0, "finger width as drawn", "um", live=False)
    finger_gap_um: LengthUm = parameter(2.0, "gap between fingers as drawn", "um", live=False)
    comb_bias_um: EtchUm = parameter(0.05, "etch bias per edge of fingers", "um", live=False)
    overlap_um: LengthUm = parameter(40.0, "undeflected finger overlap", "um", live=False)
    plate_length_um: LengthUm = parameter(190.0, "length of the plate", "um", live=False)
    plate_width_um: LengthUm = parameter(75.0, "width of the plate", "um", live=False)
    arm_width_um: PartUm = parameter(11.132, "width of a comb arm", "um", live=False)
    arm_length_um: PartUm = parameter(690.0, "length of a comb arm", "um", live=False)
    openings_um2: float = parameter(
        3665.7, "anchor notches and grating cut out of the plate", "um^2", ge=0, le=1e10, live=False
    )
    youngs_modulus_gpa: float = parameter(164.0, "Young's modulus", "GPa", ge=1e-3, le=1e4, live=False)
    density_kg_m3: float = parameter(2330.0, "density", "kg/m^3", ge=1.0, le=1e5, live=False)

    @model_validator(mode="after")
    def _possible(self) -> Self:
        for what, left in (("beams", self.beam_um), ("trusses", self.truss_um), ("fingers", self.finger_um)):
            if left <= 0.0:
                raise ValueError(f"nothing is left of the {what}: the etch bias per edge takes their whole width")
        if self.gap_um <= 0.0:
            raise ValueError("the fingers touch: the etch bias per edge closes the gap between them")
        if self.overlap_um > self.finger_length_um:
            raise ValueError("the fingers overlap by more than their length: overlap_um must be <= finger_length_um")
        if self.areas_um2[0] <= 0.0:
            raise ValueError("nothing is left of the shuttle: openings_um2 is more than plate, arms and fingers")
        return self

    @property
    def beam_um(self) -> float:
        """Width of a beam as etched."""
        return self.beam_width_um - 2.0 * self.beam_bias_um

    @property
    def truss_um(self) -> float:
        """Width of a truss as etched."""
        return self.truss_width_um - 2.0 * self.beam_bias_um

    @property
    def finger_um(self) -> float:
        """Width of a finger as etched."""
        return self.finger_width_um - 2.0 * self.comb_bias_um

    @property
    def gap_um(self) -> float:
        """Gap between fingers as etched."""
        return self.finger_gap_um + 2.0 * self.comb_bias_um

    @property
    def stator_tip_um(self) -> float:
        """Distance of the stator's finger tips from the centre: where the overlap begins."""
        return 0.5 * self.plate_length_um + self.arm_width_um + self.finger_length_um - self.overlap_um

    @property
    def far_finger_um(self) -> float:
        """Distance of the outermost finger from the x axis."""
        return (self.fingers - 1) * (self.finger_width_um + self.finger_gap_um)

    @property
    def areas_um2(self) -> tuple[float, float, float, float]:
        """Plan areas of shuttle, beams and trusses, and facing area of the combs."""
        plate = self.plate_length_um * self.plate_width_um - self.openings_um2
        arms = 2.0 * self.arm_width_um * self.arm_length_um
        shuttle = plate + arms + 2.0 * self.fingers * self.finger_length_um * self.finger_um
        beams = 8.0 * self.beam_length_um * self.beam_um
        trusses = 2.0 * 3.0 * self.truss_segment_um * self.truss_um
        combs = 4.0 * self.fingers * self.overlap_um * self.thickness_um
        return shuttle, beams, trusses, combs

    def mass_kg(self) -> float:
        r"""Effective mass, :math:`m=m_s+\tfrac14 m_t+\tfrac{12}{35}m_b` (1.3.3, Rayleigh)."""
        shuttle, beams, trusses, _ = self.areas_um2
        per_area = self.density_kg_m3 * self.thickness_um * 1e-18
        return per_area * (shuttle + trusses / 4.0 + 12.0 * beams / 35.0)

    def stiffness_n_m(self) -> float:
        r"""Stiffness of the whole suspension (1.3.4) with :math:`\alpha=(w_t/w_b)^3`.

        .. math:: k_x=\frac{2Etw^3}{L^3}\,
            \frac{L_t^2+14\alpha L_tL+36\alpha^2L^2}{4L_t^2+41\alpha L_tL+36\alpha^2L^2}
        """
        length, segment = self.beam_length_um, self.truss_segment_um
        ratio, slender = self.truss_um / self.beam_um, self.beam_um / length
        alpha = ratio * ratio * ratio
        stiff = 36.0 * alpha * alpha * length * length
        fraction = (segment * segment + 14.0 * alpha * segment * length + stiff) / (
            4.0 * segment * segment + 41.0 * alpha * segment * length + stiff
        )
        base = 2.0 * self.youngs_modulus_gpa * 1e9 * self.thickness_um * 1e-6 * slender * slender * slender
        return base * fraction

    @property
    def film(self) -> tuple[float, float, float, float]:
        """Plan area over the film as weighted by 1.3.7 and its thickness, facing area of the combs and their gap."""
        shuttle, beams, trusses, combs = self.areas_um2
        return shuttle + trusses / 2.0 + beams / 2.0, self.film_gap_um, combs, self.gap_um

    def damping_ns_m(self, temperature_k: float = ROOM_K) -> float:
        r"""Couette and Stokes damping at 1 atm (1.3.7; not squeeze film, as the text has it).

        .. math:: \beta=\mu\left[(A_s+\tfrac12A_t+\tfrac12A_b)\left(\tfrac1d+\tfrac1\delta\right)
            +\tfrac{A_c}{g}\right],\quad \delta=\sqrt{2\mu/(\rho_{gas}\omega_0)}
        """
        plan, film, combs, gap = self.film
        root: float = np.sqrt(np.sqrt(self.stiffness_n_m() / self.mass_kg()))  # of the angular frequency
        delta = penetration_depth_um(ATMOSPHERE_PA, temperature_k, 1.0) / root
        per_um = plan * (1.0 / film + 1.0 / delta) + combs / gap
        return viscosity(temperature_k) * 1e-6 * per_um

    def capacitance_gradient(self) -> float:
        r"""dC/dx of one comb, F/m: :math:`2n\varepsilon_0t/g` (n rotor fingers, two gaps each)."""
        return 2.0 * self.fingers * EPSILON_0 * self.thickness_um / self.gap_um


def drawn(context: Context) -> Geometry:
    """Return the drawing of the device on the bench; the drawing of LCR-350 if it has none."""
    return context.drawing if isinstance(context.drawing, Geometry) else Geometry()
