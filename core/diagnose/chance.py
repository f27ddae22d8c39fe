"""Bounds that chance alone seldom passes."""

from __future__ import annotations

from scipy.special import chdtri

DIGITS = 12
"""The library's last digits depend on the machine; these do not."""


def chi_square(freedom: float, chance: float) -> float:
    """Return the value that a chi-square variable with these degrees of freedom exceeds with a probability."""
    return float(f"{chdtri(freedom, chance):.{DIGITS}g}")
