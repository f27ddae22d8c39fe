"""Bias at which a perfectly aligned shuttle turns into its stators by itself."""

from __future__ import annotations

import math


def rotation_pull_in_v(
    stiffness_nm: float, gradient_f_m: float, gap_um: float, stator_tip_um: float, overlap_um: float
) -> float:
    r"""Return the bias at which the rotation becomes unstable.

    .. math:: V_b=\sqrt{\frac{k_\theta g^3}{4n\varepsilon_0t\,(X_r^3-X_s^3)/3}}

    Parameters
    ----------
    stiffness_nm : float
        Stiffness against rotation, N m/rad.
    gradient_f_m : float
        dC/dx of one comb, F/m, which is :math:`2n\varepsilon_0t/g`.
    gap_um, stator_tip_um, overlap_um : float
        Gap, distance of the stator tips from the centre, overlap.

    Returns
    -------
    float
        Volts.
    """
    rotor = stator_tip_um + overlap_um
    lever = (rotor * rotor * rotor - stator_tip_um * stator_tip_um * stator_tip_um) / 3.0 * 1e-18
    gap = gap_um * 1e-6
    return math.sqrt(stiffness_nm * gap * gap / (2.0 * gradient_f_m * lever))
