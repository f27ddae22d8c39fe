"""The angle of a point."""

from __future__ import annotations

from math import copysign

from core.elementary.bits import product_error, sum_error
from core.kernel import kernel

A0, A1, A2 = 3.33333333333329318027e-01, -1.99999999998764832476e-01, 1.42857142725034663711e-01
A3, A4, A5 = -1.11111104054623557880e-01, 9.09088713343650656196e-02, -7.69187620504482999495e-02
A6, A7, A8 = 6.66107313738753120669e-02, -5.83357013379057348645e-02, 4.97687799461593236017e-02
A9, A10 = -3.65315727442169155270e-02, 1.62858201153657823623e-02
HALF_HIGH, HALF_LOW = 4.63647609000806093515e-01, 2.26987774529616870924e-17
ONE_HIGH, ONE_LOW = 7.85398163397448278999e-01, 3.06161699786838301793e-17
PI_HIGH, PI_LOW = 3.14159265358979311600, 1.22464679914735317723e-16
"""Arcus tangents of 1/2 and 1, and a half turn, each with the remainder that a double lacks."""
BIG, TINY = 3.273390607896142e150, 3.0549363634996047e-151
"""2^500 and 2^-500: points further out or in are scaled, so that no product leaves the range."""


@kernel
def atan2(y: float, x: float) -> float:
    r"""Return the angle of the point (x, y), rad; of finite numbers.

    .. math:: \arctan t=\arctan b+\arctan\frac{t-b}{1+bt},\qquad t=\frac{\min(|x|,|y|)}{\max(|x|,|y|)},
              \ b\in\{0,\tfrac12,1\}

    with the polynomial of fdlibm (Sun Microsystems 1993, s_atan). What rounding takes off both quotients is put back.
    """
    across, up = abs(x), abs(y)
    is_steep = up > across
    most = up if is_steep else across
    least = across if is_steep else up
    scale = TINY if most > BIG else BIG if most < TINY else 1.0
    most, least = most * scale, least * scale
    most = 1.0 if most == 0.0 else most
    t = least / most
    b = 0.0 if t < 0.4375 else 0.5 if t < 0.6875 else 1.0
    high = 0.0 if t < 0.4375 else HALF_HIGH if t < 0.6875 else ONE_HIGH
    low = 0.0 if t < 0.4375 else HALF_LOW if t < 0.6875 else ONE_LOW
    # (t - b) / (1 + b t) of the numbers themselves; b is a power of 2, so its products are exact
    above, below = least - b * most, most + b * least
    above_rest, below_rest = sum_error(least, -b * most, above), sum_error(most, b * least, below)
    u = above / below
    whole = u * below
    rest = ((above - whole) - product_error(u, below, whole) + above_rest - u * below_rest) / below
    z = u * u
    w = z * z
    odd = z * (A0 + w * (A2 + w * (A4 + w * (A6 + w * (A8 + w * A10)))))
    even = w * (A1 + w * (A3 + w * (A5 + w * (A7 + w * A9))))
    lack = u * (odd + even) - rest
    sign = -1.0 if is_steep != (x < 0.0) else 1.0
    turn = 0.5 * PI_HIGH if is_steep else PI_HIGH if x < 0.0 else 0.0
    turn_rest = 0.5 * PI_LOW if is_steep else PI_LOW if x < 0.0 else 0.0
    base = turn + sign * high
    base_rest = sum_error(turn, sign * high, base) + turn_rest + sign * low
    return copysign(base + (sign * (u - lack) + base_rest), y)
