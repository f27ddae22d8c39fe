"""Mechanics of a drawing across its drive: sideways and in rotation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

from core.device.environment import ATMOSPHERE_PA, ROOM_K, penetration_depth_um, viscosity
from core.device.frame import stiffness
from core.device.geometry import Geometry


@dataclass(frozen=True)
class Lateral:
    """Mechanics that a plant in the plane needs beyond the motion along x, by the names of its parameters."""

    gap_um: float
    stator_tip_um: float
    overlap_um: float
    inertia_kg_m2: float
    lateral_stiffness_n_m: float
    lateral_reach_um: float
    rotation_stiffness_nm: float
    rotation_reach_um: float
    lateral_damping_ns_m: float
    rotation_damping_nms: float
    squeeze_ns_m: float


@lru_cache(maxsize=256)
def lateral(geometry: Geometry) -> Lateral:
    r"""Return the lateral mechanics of a drawing.

    The stiffness without load comes from the frame of beams. With the travel beams bow and give way along their length,

    .. math:: k_y=\frac{k_{y0}}{1+(x/x_y)^2},\; x_y^2=\frac{200EI}{3Lk_{y0}},\qquad
        k_\theta=\frac{k_{\theta0}}{1+(x/x_\theta)^2},\;
        x_\theta^2=\tfrac{2800}{12}w_b^2\left(1+\frac{EA}{L}\,\frac{s^3}{20EI_t}\right)

    the first by Legtenberg et al. 1996 (recalled), the second from the compliance of a guided beam along its length,
    :math:`L/EA+L\delta^2/700EI` with :math:`\delta=x/2`, in series with the bending of the trusses over the distance
    :math:`s` between beams. Both are within 4 % of a frame at large displacements, up to 15 um of travel.

    Gas: Couette and Stokes flow as along x, with the beams at their share of the motion, and between fingers the
    squeeze film :math:`4n\mu L_0t^3/g^3` of a continuous gas; a rotation shears the combs as well.

    Parameters
    ----------
    geometry : Geometry
        The drawing.

    Returns
    -------
    Lateral
        At 300 K and 1 atm.
    """
    shuttle, beams, trusses, combs = geometry.areas_um2
    # as in 1.3.3: the share of the flexures that moves with the shuttle
    moving = trusses / 4.0 + 12.0 * beams / 35.0
    frame = stiffness(geometry)
    sideways, turning = float(frame[1, 1]), float(frame[2, 2])
    modulus = 1e3 * geometry.youngs_modulus_gpa
    length, segment = geometry.beam_length_um, geometry.truss_segment_um
    bending = modulus * geometry.thickness_um * geometry.beam_um**3 / 12.0
    truss_bending = modulus * geometry.thickness_um * geometry.truss_um**3 / 12.0
    along = modulus * geometry.thickness_um * geometry.beam_um / length
    bowed = 2800.0 / 12.0 * geometry.beam_um**2
    omega = math.sqrt(geometry.stiffness_n_m() / geometry.mass_kg())
    mu = viscosity(ROOM_K)
    per_area = 1e-6 * mu * (1.0 / geometry.film_gap_um + 1.0 / penetration_depth_um(ATMOSPHERE_PA, ROOM_K, omega))
    rigid = shuttle_moment_um4(geometry)
    beside = 0.25 * (geometry.plate_width_um + length) ** 2 + 1.25 * segment**2
    squeezed = 4.0 * geometry.fingers * geometry.overlap_um * (geometry.thickness_um / geometry.gap_um) ** 3
    return Lateral(
        gap_um=geometry.gap_um,
        stator_tip_um=geometry.stator_tip_um,
        overlap_um=geometry.overlap_um,
        inertia_kg_m2=geometry.density_kg_m3 * geometry.thickness_um * 1e-30 * (rigid + moving * beside),
        lateral_stiffness_n_m=sideways,
        lateral_reach_um=math.sqrt(200.0 * bending / (3.0 * length * sideways)),
        rotation_stiffness_nm=1e-12 * turning,
        rotation_reach_um=math.sqrt(bowed * (1.0 + along * segment**3 / (20.0 * truss_bending))),
        lateral_damping_ns_m=per_area * (shuttle + moving),
        rotation_damping_nms=1e-12
        * (per_area * rigid + 1e-6 * mu * combs / geometry.gap_um * comb_square_um2(geometry)),
        squeeze_ns_m=1e-6 * mu * squeezed,
    )


def comb_square_um2(geometry: Geometry) -> float:
    r"""Return the mean square of the distance of n fingers from the x axis, :math:`\tfrac13Y^2\frac{n+1}{n-1}`."""
    n = geometry.fingers
    return geometry.far_finger_um**2 / 3.0 * (n + 1.0) / (n - 1.0) if n > 1 else 0.0


def shuttle_moment_um4(geometry: Geometry) -> float:
    """Return the polar moment of area of plate, arms and fingers about the centre; openings are close to it."""

    def box(width: float, height: float, away_square: float = 0.0) -> float:
        return width * height * ((width * width + height * height) / 12.0 + away_square)

    plate, arm = geometry.plate_length_um, geometry.arm_width_um
    size = plate * plate + geometry.plate_width_um**2
    finger = geometry.finger_width_um - 2.0 * geometry.comb_bias_um
    at_arm = 0.5 * (plate + arm)
    at_finger = 0.5 * (plate + geometry.finger_length_um) + arm
    whole = box(plate, geometry.plate_width_um) - geometry.openings_um2 * size / 36.0
    whole += 2.0 * box(arm, geometry.arm_length_um, at_arm * at_arm)
    fingers = box(geometry.finger_length_um, finger, at_finger * at_finger + comb_square_um2(geometry))
    return whole + 2.0 * geometry.fingers * fingers
