r"""Levitation of a comb over a grounded plane: the vertical force that a planar model leaves out.

The plane takes the field below the fingers, the field above them stays, so a grounded rotor between stators at V is
pulled upwards (Tang, Lim and Howe 1992). For each finger and length of overlap

.. math:: F_z=\tfrac12V^2\frac{dC'}{dz},

with :math:`C'` of the stator finger in the cross-section of ``core.device.fringing``, its rotor raised by z. The force
falls as the rotor rises, so the lift ends where it meets the suspension,

.. math:: k_zz=nL_0(V_1^2+V_2^2)\,\frac{F_z(z)}{V^2},\qquad k_z=k_x\left(\frac tw\right)^2 .
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from core.device.fringing import charge, finger_panels
from core.device.geometry import Geometry
from core.units import EPSILON_0

PJ_PER_J_UM = 1e6
"""pJ of a permittivity in F/m times a length in um and a squared voltage."""
STEP = 0.005
"""Step of the derivative, over the gap: it is good to a ten-thousandth."""
PASSES, NEAR = 50, 1e-9
"""Most passes of Newton's rule, and the change, over the gap, at which they end."""


@lru_cache(maxsize=4096)
def vertical_force(
    width_um: float, gap_um: float, thickness_um: float, height_um: float, rise_um: float = 0.0
) -> tuple[float, float]:
    """Return force and stiffness upwards of a rotor finger, for each length of overlap, V^2 and permittivity.

    Parameters
    ----------
    width_um, gap_um, thickness_um, height_um : float
        Of the fingers, as etched; the height is above the plane.
    rise_um : float
        Of the rotor above the stators.

    Returns
    -------
    tuple of float
        1/um and 1/um^2; a stiffness above 0 holds the rotor down.
    """
    step = STEP * gap_um
    below, level, above = (
        _capacitance(width_um, gap_um, thickness_um, height_um, rise_um + move) for move in (-step, 0.0, step)
    )
    return 0.25 * (above - below) / step, 0.5 * (2.0 * level - above - below) / (step * step)


def lift_um(
    width_um: float, gap_um: float, thickness_um: float, height_um: float, pull_pj: float, stiffness_n_m: float
) -> float:
    """Return the height at which the suspension balances the vertical force, by Newton's rule from the plane up.

    Parameters
    ----------
    width_um, gap_um, thickness_um, height_um : float
        Of the fingers, as etched; the height is above the plane.
    pull_pj : float
        Permittivity times the overlap of all fingers times the squared voltage, pJ, also uN um.
    stiffness_n_m : float
        Of the suspension, out of the plane.
    """
    rise = 0.0
    for _ in range(PASSES):
        force, stiffness = vertical_force(width_um, gap_um, thickness_um, height_um, rise)
        change = (pull_pj * force - stiffness_n_m * rise) / (stiffness_n_m + pull_pj * max(stiffness, 0.0))
        rise += change
        if abs(change) <= NEAR * gap_um:
            break
    return rise


def figures(
    drawing: Geometry, fingers: int, stators_v: tuple[float, float], stiffness_n_m: float | None
) -> dict[str, float]:
    """Return the vertical force per squared volt, and the lift at the bias if the beams are drawn.

    Parameters
    ----------
    drawing : Geometry
        The comb, and the beams.
    fingers : int
        Rotor fingers per side.
    stators_v : tuple of float
        Bias of each stator.
    stiffness_n_m : float, optional
        Of the whole suspension along x; none if the beams are not drawn.
    """
    comb = drawing.finger_um, drawing.gap_um, drawing.thickness_um, drawing.film_gap_um
    per_v2 = EPSILON_0 * PJ_PER_J_UM * fingers * drawing.overlap_um  # of one comb
    found = {"levitation_nn_per_v2": 1e3 * per_v2 * vertical_force(*comb)[0]}
    if stiffness_n_m is not None:
        first, second = stators_v
        slender = drawing.thickness_um / drawing.beam_um
        pull = per_v2 * (first * first + second * second)
        found["lift_nm"] = 1e3 * lift_um(*comb, pull, stiffness_n_m * slender * slender)
    return found


def _capacitance(width: float, gap: float, thickness: float, height: float, rise: float) -> float:
    finger = finger_panels(width, thickness)
    rotor = finger.copy()
    rotor[:, ::2] = width + gap - finger[:, ::2]
    rotor[:, 1::2] += rise
    return charge(np.concatenate([finger, rotor]), len(finger), True, 2.0 * (width + gap), height)
