"""The hyperbolic tangent."""

from __future__ import annotations

from math import copysign

from core.elementary.bits import product_error, sum_error
from core.elementary.exponential import parts, scaled
from core.kernel import kernel

P0, P1, P2 = -1.61468768441708447952e3, -9.92877231001918586564e1, -9.64399179425052238628e-1
Q0, Q1, Q2 = 4.84406305325125486048e3, 2.23548839060100448583e3, 1.12811678491632931402e2
SMALL, ONE = 0.5, 22.0
"""Below the first the fraction is used; from the second on it is 1."""


@kernel
def tanh(x: float) -> float:
    r"""Return the hyperbolic tangent.

    .. math:: \tanh x=x+x^3\frac{P(x^2)}{Q(x^2)}\quad(|x|<\tfrac12),\qquad
              \tanh x=\pm\Big(1-\frac2{e^{2|x|}+1}\Big)

    with the fraction of Cephes (Moshier 1989); what rounding takes off the exponential and the quotient is put back.
    """
    size = ONE if abs(x) > ONE else abs(x)
    z = x * x if abs(x) < SMALL else 0.0
    near = x + x * (z * ((P0 + z * (P1 + z * P2)) / (Q0 + z * (Q1 + z * (Q2 + z)))))
    power, head, tail = parts(2.0 * size)
    high, low = scaled(head, power), scaled(tail, power)
    below = high + 1.0
    low += sum_error(high, 1.0, below)
    share = 2.0 / below
    share_of = share * below
    rest = ((2.0 - share_of) - product_error(share, below, share_of) - share * low) * (0.5 * share)
    left = 1.0 - share
    far = left + (((1.0 - left) - share) - rest)
    value = near if abs(x) < SMALL else copysign(far, x)
    return value if x != 0.0 and x == x else x
