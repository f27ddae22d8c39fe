r"""Stability of the rules that adapt one gain (appendix B), by eigenvalues and by Floquet's theorem.

With the gain error :math:`x=k-k_vk_c` the error :math:`e=y_m-y` of :math:`k_v/(b_2s^2+b_1s+1)` obeys
:math:`b_2\ddot e+b_1\dot e+e=x\,r`. Each rule makes the loop a linear system whose coefficients are as periodic as r.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from core.block import FloatArray
from core.elementary import cos, sin
from core.kernel import kernel

MIT, PARKS, LYAPUNOV, DRESSLER, PRICE, MONOPOLI = 0, 1, 2, 3, 4, 5
"""``PARKS`` is the rule as derived, on the slope of the error alone; ``LYAPUNOV`` adds the error itself."""
RULES = {"mit": MIT, "parks": PARKS, "lyapunov": LYAPUNOV, "dressler": DRESSLER, "price": PRICE, "monopoli": MONOPOLI}
STEPS = 200
"""Steps of a period, at least."""
MOST_STEPS = 10_000
MARGIN = 1e-7
"""Largest growth rate, 1/time, that counts as stable."""


@dataclass(frozen=True)
class GainLoop:
    """A plant of unknown gain and the parameters of its rule, in the plant's unit of time.

    Parameters
    ----------
    b1, b2 : float
        Coefficients of the plant; b2 = 0 for first order is not covered, all rules being stable there.
    gain, model_gain : float
        kv and k.
    amplitude : float
        R of the reference R sin wt, or of the constant.
    error_weight, proportional, filter_time : float
        c of ``LYAPUNOV``, gamma of ``PRICE`` and ``MONOPOLI``, q of ``MONOPOLI``.
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
def _coefficients(
    p: FloatArray, rule: int, rate: float, r: float, ym: float, y: float
) -> tuple[float, float, float, float]:
    """Return the effects of e and e' on the slope of x, and their direct effects on the plant."""
    strength = -p[2] * rate
    if rule == MIT:
        return strength * ym, 0.0, 0.0, 0.0
    if rule == PARKS:
        return 0.0, strength * r, 0.0, 0.0
    if rule == LYAPUNOV:
        return strength * p[5] * r, strength * r, 0.0, 0.0
    if rule == MONOPOLI:
        # x' = -kv B (ey + gamma (ey)'), y' = (r - y)/q, and the voltage adds q x' y
        on_e, on_v = strength * (y + p[6] * (r - y) / p[7]), strength * p[6] * y
        return on_e, on_v, p[7] * y * on_e, p[7] * y * on_v
    if rule == PRICE:
        return strength * r, 0.0, p[6] * strength * r * r, 0.0
    return strength * r, 0.0, 0.0, 0.0


def monodromy(p: FloatArray, rule: int, rate: float, w: float) -> FloatArray:
    """Return the transition over one period of a sine (w > 0), or the matrix of the system for a constant."""
    transition = np.zeros((3, 3))
    _carry(p, rule, rate, w, transition)
    return transition


@kernel
def _carry(p: FloatArray, rule: int, rate: float, w: float, transition: FloatArray) -> None:
    """Write the transition over zeros."""
    b1, b2, k, amplitude, q = p[0], p[1], p[3], p[4], p[7]
    if w == 0.0:
        on_e, on_v, at_once, slope_at_once = _coefficients(p, rule, rate, amplitude, k * amplitude, amplitude)
        transition[0, 1] = 1.0
        transition[1, 0], transition[1, 1] = (at_once - 1.0) / b2, (slope_at_once - b1) / b2
        transition[1, 2] = amplitude / b2
        transition[2, 0], transition[2, 1] = on_e, on_v
        return
    for i in range(3):
        transition[i, i] = 1.0
    # model and filter answer R sin wt with a real and an imaginary part
    real, imaginary = 1.0 - b2 * w * w, b1 * w
    model = k * amplitude / (real * real + imaginary * imaginary)
    filtered = amplitude / (1.0 + q * q * w * w)
    steps = STEPS
    if rule == MONOPOLI:  # its part with gamma damps the plant, and the steps must follow that
        damped = 2.0 * math.pi / w * p[2] * rate * p[6] * q * amplitude * filtered / b2
        steps += int(min(damped, float(MOST_STEPS)))
    h = 2.0 * math.pi / w / steps
    r1 = 0.0
    e1, v1, g1, d1 = _coefficients(p, rule, rate, 0.0, -model * imaginary, -filtered * q * w)
    for i in range(steps):
        sine, cosine = sin(w * h * (i + 0.5)), cos(w * h * (i + 0.5))
        ym, y = model * (real * sine - imaginary * cosine), filtered * (sine - q * w * cosine)
        r2 = amplitude * sine
        e2, v2, g2, d2 = _coefficients(p, rule, rate, r2, ym, y)
        sine, cosine = sin(w * h * (i + 1.0)), cos(w * h * (i + 1.0))
        ym, y = model * (real * sine - imaginary * cosine), filtered * (sine - q * w * cosine)
        r3 = amplitude * sine
        e3, v3, g3, d3 = _coefficients(p, rule, rate, r3, ym, y)
        for c in range(3):
            e, v, x = transition[0, c], transition[1, c], transition[2, c]
            ka, la, ma = v, (x * r1 + (g1 - 1.0) * e + (d1 - b1) * v) / b2, e1 * e + v1 * v
            et, vt, xt = e + 0.5 * h * ka, v + 0.5 * h * la, x + 0.5 * h * ma
            kb, lb, mb = vt, (xt * r2 + (g2 - 1.0) * et + (d2 - b1) * vt) / b2, e2 * et + v2 * vt
            et, vt, xt = e + 0.5 * h * kb, v + 0.5 * h * lb, x + 0.5 * h * mb
            kc, lc, mc = vt, (xt * r2 + (g2 - 1.0) * et + (d2 - b1) * vt) / b2, e2 * et + v2 * vt
            et, vt, xt = e + h * kc, v + h * lc, x + h * mc
            kd, ld, md = vt, (xt * r3 + (g3 - 1.0) * et + (d3 - b1) * vt) / b2, e3 * et + v3 * vt
            transition[0, c] = e + h / 6.0 * (ka + 2.0 * kb + 2.0 * kc + kd)
            transition[1, c] = v + h / 6.0 * (la + 2.0 * lb + 2.0 * lc + ld)
            transition[2, c] = x + h / 6.0 * (ma + 2.0 * mb + 2.0 * mc + md)
        r1, e1, v1, g1, d1 = r3, e3, v3, g3, d3


def growth(loop: GainLoop, rule: int, rate: float, w: float) -> float:
    """Return the growth rate of the worst solution, 1/time: negative when all decay.

    If a solution overflows within one period, the rate returned is a lower bound.
    """
    matrix = monodromy(loop.packed(), rule, rate, w)
    if not np.all(np.isfinite(matrix)):
        return math.log(float(np.finfo(np.float64).max)) * w / (2.0 * math.pi)
    roots = np.linalg.eigvals(matrix)
    if w == 0.0:
        return float(np.max(roots.real))
    return float(np.log(max(float(np.max(np.abs(roots))), 1e-300)) * w / (2.0 * math.pi))


def critical_gain(loop: GainLoop, rule: int, w: float, most: float = 10.0, points: int = 200) -> float:
    """Return the first adaptation gain beyond which a solution grows, or ``most`` if none grows up to there."""
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
