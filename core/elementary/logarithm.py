"""The natural logarithm."""

from __future__ import annotations

from math import inf, nan

from core.elementary.bits import bits_of, number_of
from core.elementary.exponential import LN2_HIGH, LN2_LOW
from core.kernel import kernel

L1, L2, L3, L4 = 6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01, 2.222219843214978396e-01
L5, L6, L7 = 1.818357216161805012e-01, 1.531383769920937332e-01, 1.479819860511658591e-01
ROOT_HALF = bits_of(0.7071067811865476)
LEAST_NORMAL, TWO_POW_54 = 2.2250738585072014e-308, 18014398509481984.0


@kernel
def log(x: float) -> float:
    r"""Return the natural logarithm; minus infinity of zero, NaN below.

    .. math:: x=2^k(1+f),\qquad \ln(1+f)=f-\Big(\frac{f^2}{2}-s\Big(\frac{f^2}{2}+R(s^2)\Big)\Big),\qquad
              s=\frac f{2+f}

    with :math:`\sqrt{1/2}\le 1+f<\sqrt 2` and the polynomial R of fdlibm (Sun Microsystems 1993, e_log).
    """
    is_small = x < LEAST_NORMAL
    bits = bits_of(x * TWO_POW_54 if is_small else x)
    power = (bits - ROOT_HALF) >> 52
    f = number_of(bits - (power << 52)) - 1.0
    k = float(power - 54 if is_small else power)
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    r = w * (L2 + w * (L4 + w * L6)) + z * (L1 + w * (L3 + w * (L5 + w * L7)))
    half_square = 0.5 * f * f
    value = k * LN2_HIGH - ((half_square - (s * (half_square + r) + k * LN2_LOW)) - f)
    value = x if x == inf else value
    value = -inf if x == 0.0 else value
    return value if x >= 0.0 else nan
