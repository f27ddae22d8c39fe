"""Design the constants of ``h_infinity.py``: ``python docs/units/design_h_infinity.py`` prints them.

Loop shaping with a constant weight and the normalised coprime factors of the device (McFarlane and Glover 1992, theorem
4.14; Skogestad and Postlethwaite 2005, section 9.4). Time is in units of 1/w0, voltage in units of k/F per um.
"""

import math

import numpy as np
from scipy.linalg import solve_continuous_are

MASS_KG, DAMPING_NS_M, STIFFNESS_N_M = 2.209e-10, 7.09e-7, 0.0538
"""The device ``ch3``."""
WEIGHT = 10.0
"""Loop gain at zero frequency before the design."""
ABOVE_LEAST = 1.1
"""Bound of the norm over the least that any controller can have."""


def device() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return A, B and C of the weighed device."""
    ratio = DAMPING_NS_M / (2.0 * math.sqrt(MASS_KG * STIFFNESS_N_M))
    a = np.array([[0.0, 1.0], [-1.0, -2.0 * ratio]])
    return a, np.array([[0.0], [WEIGHT]]), np.array([[1.0, 0.0]])


def design() -> tuple[float, np.ndarray, np.ndarray]:
    """Return the bound of the norm, and numerator and denominator of the controller, the weight included."""
    a, b, c = device()
    x = solve_continuous_are(a, b, c.T @ c, np.eye(1))
    z = solve_continuous_are(a.T, c.T, b @ b.T, np.eye(1))
    bound = ABOVE_LEAST * math.sqrt(1.0 + max(np.linalg.eigvals(x @ z).real))
    enters = bound**2 * np.linalg.solve(((1.0 - bound**2) * np.eye(2) + x @ z).T, z @ c.T)
    inner, leaves = a - b @ b.T @ x + enters @ c, -b.T @ x  # the sign makes the feedback negative
    denominator = np.poly(inner)
    numerator = np.poly(inner + enters @ leaves) - denominator  # det(sI - A - BC) = den - C adj B
    return bound, -WEIGHT * numerator[1:], denominator


if __name__ == "__main__":
    bound, numerator, denominator = design()
    print(f"BOUND = {bound:.6g}")
    print(f"NUMERATOR = ({numerator[0]:.8g}, {numerator[1]:.8g})")
    print(f"DENOMINATOR = ({denominator[1]:.8g}, {denominator[2]:.8g})")
