r"""Stability of the rules that adapt one gain (appendix B), by eigenvalues and by Floquet's theorem.

With the gain error :math:`x=k-k_vk_c` the error :math:`e=y_m-y` of :math:`k_v/(b_2s^2+b_1s+1)` obeys
:math:`b_2\ddot e+b_1\dot e+e=x\,r`, and each rule makes the whole linear with coefficients as periodic as r.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from core.block import FloatArray, kernel

MIT, PARKS, LYAPUNOV, DRESSLER, PRICE, MONOPOLI = range(6)
"""``PARKS`` is the rule as derived, on the slope of the error alone; ``LYAPUNOV`` adds the error itself."""
RULES = {"mit": MIT, "parks": PARKS, "lyapunov": LYAPUNOV, "dressler": DRESSLER, "price": PRICE, "monopoli": MONOPOLI}
STEPS = 300
"""Steps of a period."""
MARGIN = 1e-7
"""Growth rate, 1/time, that counts as none."""


@dataclass(frozen=True)
class GainLoop:
    """A plant of unknown gain, and what its rule needs, in its own unit of time.

    Parameters
    ----------
    b1, b2 : float
        Coefficients of the plant; b2 = 0 for first order is not covered, all rules being stable there.
    gain, model_gain : float
        kv and k.
    amplitude : float
        R of the reference R sin wt, or of the constant.
    error_weight, proportional, filter_time : float
        c of ``LYAPUNOV``, gamma of ``PRICE``, q of ``MONOPOLI``.
    """

    b1: float = 1.0
    b2: float = 1.0
    gain: float = 1.0
    model_gain: float = 1.0
    amplitude: float = 1.0
    error_weight: float = 0.5
    proportional: float = 1.0
    filter_time: float = 1.5

    def packed(self) -> FloatArray:
        """Return the numbers in the order given."""
        return np.array(
            [
                self.b1,
                self.b2,
                self.gain,
                self.model_gain,
                self.amplitude,
                self.error_weight,
                self.proportional,
                self.filter_time,
            ]
        )


@kernel
def _slope(
    p: FloatArray, rule: int, rate: float, r: float, ym: float, y: float, s: FloatArray, out: FloatArray
) -> None:
    """Write the slope of e, e' and x."""
    b1, b2, kv = p[0], p[1], p[2]
    e, v, x = s[0], s[1], s[2]
    push = x * r
    if rule == MIT:
        change = -kv * rate * e * ym
    elif rule == PARKS:
        change = -kv * rate * v * r
    elif rule == LYAPUNOV:
        change = -kv * rate * (v + p[5] * e) * r
    elif rule == MONOPOLI:
        change = -kv * rate * e * y
        push += p[7] * change * y
    else:
        change = -kv * rate * e * r
        if rule == PRICE:
            push -= kv * p[6] * rate * e * r * r
    out[0] = v
    out[1] = (push - b1 * v - e) / b2
    out[2] = change


@kernel
def _ahead(s: FloatArray, slope: FloatArray, h: float, out: FloatArray) -> None:
    """Write s + h slope."""
    for j in range(3):
        out[j] = s[j] + h * slope[j]


@kernel
def monodromy(p: FloatArray, rule: int, rate: float, w: float) -> FloatArray:
    """Return the transition over one period of a sine (w > 0), or the matrix of the system for a constant."""
    b1, b2, k, amplitude, q = p[0], p[1], p[3], p[4], p[7]
    found = np.zeros((3, 3))
    s, a1, a2, a3, a4, t = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    if w == 0.0:
        for column in range(3):
            s[:] = 0.0
            s[column] = 1.0
            _slope(p, rule, rate, amplitude, k * amplitude, amplitude, s, a1)
            found[:, column] = a1
        return found
    # the responses of model and filter to R sin wt: real and imaginary parts
    real, imaginary = 1.0 - b2 * w * w, b1 * w
    size = real * real + imaginary * imaginary
    h = 2.0 * math.pi / w / STEPS
    for column in range(3):
        s[:] = 0.0
        s[column] = 1.0
        for i in range(STEPS):
            for stage in range(4):
                at = w * h * (i + (0.0 if stage == 0 else 1.0 if stage == 3 else 0.5))
                sine, cosine = math.sin(at), math.cos(at)
                r = amplitude * sine
                ym = k * amplitude * (real * sine - imaginary * cosine) / size
                y = amplitude * (sine - q * w * cosine) / (1.0 + q * q * w * w)
                if stage == 0:
                    _slope(p, rule, rate, r, ym, y, s, a1)
                elif stage == 1:
                    _ahead(s, a1, 0.5 * h, t)
                    _slope(p, rule, rate, r, ym, y, t, a2)
                elif stage == 2:
                    _ahead(s, a2, 0.5 * h, t)
                    _slope(p, rule, rate, r, ym, y, t, a3)
                else:
                    _ahead(s, a3, h, t)
                    _slope(p, rule, rate, r, ym, y, t, a4)
            for j in range(3):
                s[j] += h / 6.0 * (a1[j] + 2.0 * a2[j] + 2.0 * a3[j] + a4[j])
        found[:, column] = s
    return found


def growth(loop: GainLoop, rule: int, rate: float, w: float) -> float:
    """Return the growth rate of the worst solution, 1/time: negative when all decay."""
    matrix = monodromy(loop.packed(), rule, rate, w)
    roots = np.linalg.eigvals(matrix)
    if w == 0.0:
        return float(np.max(roots.real))
    return float(np.log(max(float(np.max(np.abs(roots))), 1e-300)) * w / (2.0 * math.pi))


def critical_gain(loop: GainLoop, rule: int, w: float, most: float = 10.0, points: int = 400) -> float:
    """Return the first adaptation gain beyond which a solution grows; ``most`` when none does up to there."""
    below = 0.0
    for rate in np.linspace(most / points, most, points):
        if growth(loop, rule, float(rate), w) > MARGIN:
            low, high = below, float(rate)
            for _ in range(40):
                middle = 0.5 * (low + high)
                low, high = (low, middle) if growth(loop, rule, middle, w) > MARGIN else (middle, high)
            return high
        below = float(rate)
    return most


def instability_map(loop: GainLoop, rule: int, rates: FloatArray, frequencies: FloatArray) -> FloatArray:
    """Return the growth rate for each frequency (rows) and adaptation gain (columns)."""
    return np.array([[growth(loop, rule, float(rate), float(w)) for rate in rates] for w in frequencies])
