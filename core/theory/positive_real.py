r"""Positive real and strictly positive real transfer functions (A.11), exactly.

On the imaginary axis :math:`\mathrm{Re}\,G=\mathrm{Re}[N(j\omega)D(-j\omega)]/|D|^2`, and the numerator is a polynomial
in :math:`\omega^2`: its extremes are at the roots of its derivative, so no grid is needed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.block import FloatArray
from core.errors import InputError

LARGEST = 1e30
"""Coefficients beyond this, or below its inverse, would make products that overflow or underflow."""
TINY = 1e-10
MOST = 20
"""Highest order that roots of polynomials in double precision can be trusted with."""


@dataclass(frozen=True)
class PositiveRealVerdict:
    """Verdict on a transfer function, with its reasons.

    Parameters
    ----------
    strictly_positive_real, positive_real : bool
        The verdicts.
    hurwitz, minimum_phase : bool
        Whether all poles, and all zeros, have a negative real part.
    relative_degree : int
        Degree of the denominator less the degree of the numerator.
    least_real : float
        Smallest real part on the imaginary axis; huge if a pole on the axis makes it so.
    at : float
        Frequency of that smallest real part, infinite if it is the limit at infinity.
    reasons : tuple of str
        The conditions it fails to be strictly positive real.
    """

    strictly_positive_real: bool
    positive_real: bool
    hurwitz: bool
    minimum_phase: bool
    relative_degree: int
    least_real: float
    at: float
    reasons: tuple[str, ...]


def polynomial(coefficients: Sequence[float], field: str) -> FloatArray:
    """Return coefficients without leading zeros, highest power first; refuse coefficients that make no polynomial."""
    values = np.asarray(coefficients, dtype=np.float64)
    if values.ndim != 1 or not np.all(np.isfinite(values)) or not np.any(values):
        raise InputError("must be finite numbers, not all 0", field)
    values = values[np.flatnonzero(values)[0] :]
    sizes = np.abs(values[values != 0.0])
    if sizes.min() < 1.0 / LARGEST or sizes.max() > LARGEST:
        raise InputError(f"must be 0 or between {1.0 / LARGEST:g} and {LARGEST:g} in size", field)
    if len(values) > MOST + 1:
        raise InputError(f"must be of order {MOST} or less", field)
    return values


def real_part(numerator: FloatArray, denominator: FloatArray) -> FloatArray:
    r"""Return :math:`\mathrm{Re}[N(j\omega)D(-j\omega)]` as a polynomial in :math:`x=\omega^2`, highest power first."""
    product = np.polymul(numerator, denominator * (-1.0) ** np.arange(len(denominator) - 1, -1, -1))
    powers = np.arange(len(product) - 1, -1, -1)
    even = powers % 2 == 0
    return np.asarray(product[even] * (-1.0) ** (powers[even] // 2), dtype=np.float64)


def positive_real(numerator: Sequence[float], denominator: Sequence[float]) -> PositiveRealVerdict:
    r"""Judge :math:`N(s)/D(s)`; coefficients highest power first.

    It is strictly positive real when D is Hurwitz, the relative degree is -1, 0 or 1,
    :math:`\mathrm{Re}\,G(j\omega)>0` for all :math:`\omega`, and at infinity :math:`\omega^2\mathrm{Re}\,G\not\to0` for
    relative degree 1, :math:`\mathrm{Re}\,G\not\to0` for -1: then :math:`G(s-\epsilon)` can be positive real (Ioannou
    and Sun, Robust Adaptive Control, 3.5). It is positive real when the real part is nowhere negative and poles on the
    imaginary axis are simple with positive residues.

    Raises
    ------
    InputError
        For coefficients that make no transfer function.
    """
    n, d = polynomial(numerator, "numerator"), polynomial(denominator, "denominator")
    degree = len(d) - len(n)
    poles, zeros = np.roots(d), np.roots(n)
    hurwitz, minimum = _left(poles), _left(zeros)
    real = real_part(n, d)
    scale = float(np.sum(np.abs(np.polymul(n, d))))
    lowest = _least(real) / scale
    at, least_real = _least_real(real, real_part(d, d))
    reasons = []
    if not hurwitz:
        reasons.append("a pole is not in the left half plane")
    if abs(degree) > 1:
        reasons.append(f"the relative degree is {degree}")
    if lowest < -TINY:
        reasons.append("the real part is negative")
    elif lowest <= TINY:
        reasons.append("the real part touches zero")
    # at infinity: degrees 0 and -1 need the highest power that the real part may have, degree 1 needs the power of w^2
    # Re G
    most = len(n) + len(d) - 2
    wanted = {0: most, 1: most - 1, -1: most - 1}.get(degree, 0) // 2
    leading = real[-1 - wanted] if wanted < len(real) else 0.0
    if abs(degree) <= 1 and leading <= TINY * scale and lowest > TINY:
        reasons.append("the real part vanishes too fast at high frequency")
    if n[0] * d[0] < 0.0 and abs(degree) == 1:
        reasons.append("the sign at high frequency is wrong")
    return PositiveRealVerdict(
        strictly_positive_real=not reasons,
        positive_real=abs(degree) <= 1 and lowest >= -TINY and n[0] * d[0] > 0.0 and _axis_poles_are_positive(n, d),
        hurwitz=hurwitz,
        minimum_phase=minimum,
        relative_degree=degree,
        least_real=least_real,
        at=at,
        reasons=tuple(reasons),
    )


def nyquist(numerator: Sequence[float], denominator: Sequence[float], w: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return real and imaginary part of G(jw)."""
    n, d = polynomial(numerator, "numerator"), polynomial(denominator, "denominator")
    values = np.polyval(n, 1j * w) / np.polyval(d, 1j * w)
    return values.real, values.imag


def _left(roots: Any) -> bool:
    """Say whether all roots have a negative real part."""
    return bool(np.all(roots.real < -TINY * np.maximum(1.0, np.abs(roots))))


def _turns(values: Any) -> list[float]:
    """Return 0 and the positive real roots of a polynomial."""
    roots = np.roots(values)
    return [0.0, *(float(root.real) for root in roots if root.real > 0.0 and abs(root.imag) < 1e-6 * abs(root))]


def _least(real: FloatArray) -> float:
    """Return the smallest value of a polynomial on x >= 0, or minus infinity if it has no lower bound."""
    values = np.trim_zeros(real, "f")
    if len(values) > 1 and values[0] < 0.0:
        return -math.inf
    return min((float(np.polyval(values, x)) for x in _turns(np.polyder(values))), default=0.0) if len(values) else 0.0


def _least_real(real: FloatArray, square: FloatArray) -> tuple[float, float]:
    """Return the frequency at which Re G = P/Q is smallest, and its value; P and Q are polynomials in w^2."""
    slopes: Any = np.polyder(real), np.polyder(square)
    turning: Any = np.polysub(np.polymul(slopes[0], square), np.polymul(real, slopes[1]))
    top: Any = np.trim_zeros(real, "f")
    bottom: Any = np.trim_zeros(square, "f")
    candidates = []
    for turn in _turns(turning):
        beside = float(np.polyval(bottom, turn)) <= TINY * float(np.sum(np.abs(bottom)))
        x = turn * (1.0 + 1e-6) + 1e-9 if beside else turn  # next to a pole on the axis
        candidates.append((math.sqrt(x), float(np.polyval(top, x) / np.polyval(bottom, x))))
    far = 0.0
    if len(top) >= len(bottom):
        far = float(top[0] / bottom[0]) if len(top) == len(bottom) else math.copysign(math.inf, float(top[0]))
    return min([*candidates, (math.inf, far)], key=lambda pair: pair[1])


def _axis_poles_are_positive(n: FloatArray, d: FloatArray) -> bool:
    """Say whether no pole is to the right, and those on the axis are simple with a positive real residue."""
    slope = np.polyder(d)
    for pole in np.roots(d):
        # a pole on the axis comes out with a rounding error that grows with its multiplicity
        if pole.real > 1e-6 * max(1.0, abs(pole)):
            return False
        if abs(pole.real) <= 1e-6 * max(1.0, abs(pole)):
            change = np.polyval(slope, pole)
            if abs(change) < 1e-5 * max(1.0, float(np.max(np.abs(d)))):
                return False
            residue = np.polyval(n, pole) / change
            if residue.real <= 0.0 or abs(residue.imag) > 1e-6 * abs(residue):
                return False
    return True
