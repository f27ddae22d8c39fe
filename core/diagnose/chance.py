"""Bounds that chance alone seldom passes."""

from __future__ import annotations

import math
from functools import lru_cache

DIGITS = 12
"""The last digits of a library's functions depend on the machine; these do not."""
LAST_STEP = 1e-8
"""Newton's error is about the square of this step, relative to the value."""


@lru_cache(maxsize=256)
def chi_square(freedom: int, chance: float) -> float:
    """Return the value that a chi-square variable with these degrees of freedom, 2 or more, exceeds with a probability.

    The logarithm of the probability is concave, so Newton's steps from the bound of Laurent and Massart only come down.
    """
    rarity = -math.log(chance)
    value, step = freedom + 2.0 * math.sqrt(freedom * rarity) + 2.0 * rarity, math.inf
    while abs(step) > LAST_STEP * value:
        density, beyond = _logarithms(freedom, value)
        step = (beyond + rarity) * math.exp(beyond - density)
        value += step
    return float(f"{value:.{DIGITS}g}")


def _logarithms(freedom: int, value: float) -> tuple[float, float]:
    """Return the logarithms of the density at a value, and of the probability beyond it.

    The probability is a sum over every second degree of freedom; the term of a degree is twice the density with it.
    """
    half = value / 2.0
    degrees = [k / 2.0 for k in range(2 + freedom % 2, freedom + 1, 2)]
    terms = [(degree - 1.0) * math.log(half) - half - math.lgamma(degree) for degree in degrees]
    density = terms[-1] - math.log(2.0)
    one_degree = math.erfc(math.sqrt(half)) if freedom % 2 else 0.0
    if one_degree > 0.0:
        terms.append(math.log(one_degree))
    greatest = max(terms)
    return density, greatest + math.log(math.fsum(math.exp(term - greatest) for term in terms))
