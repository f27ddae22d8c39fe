"""The exponential."""

from __future__ import annotations

from math import inf

from core.elementary.bits import bits_of, number_of, sum_error
from core.elementary.rounding import MAGIC
from core.kernel import kernel

PER_LN2 = 1.44269504088896338700
LN2_HIGH, LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
P1, P2, P3 = 1.66666666666666019037e-01, -2.77777777770155933842e-03, 6.61375632143793436117e-05
P4, P5 = -1.65339022054652515390e-06, 4.13813679705723846039e-08
MAGIC_BITS = bits_of(MAGIC)
LEAST, MOST = -746.0, 710.0
"""Beyond them the exponential is 0 or infinite."""


@kernel
def parts(x: float) -> tuple[int, float, float]:
    r"""Return k, h and t of :math:`e^x=2^k(h+t)`, where t is what h lacks.

    .. math:: x=k\ln 2+r,\qquad e^r=1+\frac{r\,c}{2-c}+r,\qquad c=r-r^2P(r^2)

    with the reduction and the polynomial of fdlibm (Sun Microsystems 1993, e_exp).
    """
    inside = MOST if x > MOST else x
    inside = LEAST if inside < LEAST else inside
    shifted = inside * PER_LN2 + MAGIC
    count = shifted - MAGIC
    high = inside - count * LN2_HIGH
    low = count * LN2_LOW
    r = high - low
    square = r * r
    fourth = square * square
    c = r - square * ((P1 + square * P2) + fourth * ((P3 + square * P4) + fourth * P5))
    bend = r * c / (2.0 - c) - low
    rest = high + bend
    head = 1.0 + rest
    return bits_of(shifted) - MAGIC_BITS, head, (rest - (head - 1.0)) + sum_error(high, bend, rest)


@kernel
def scaled(value: float, power: int) -> float:
    r"""Return :math:`2^k` times a value, in two factors because one alone may be out of range."""
    half = power >> 1
    first, second = (half + 1023) & 2047, (power - half + 1023) & 2047
    return value * number_of(first << 52) * number_of(second << 52)


@kernel
def expm1(x: float) -> float:
    """Return e to the power of x, less 1."""
    power, head, tail = parts(x)
    high, low = scaled(head, power), scaled(tail, power)
    less = high - 1.0
    value = less + (sum_error(high, -1.0, less) + low)
    value = (head - 1.0) + tail if power == 0 else value
    return x if abs(x) < 1e-17 or high == inf else value


@kernel
def exp(x: float) -> float:
    """Return e to the power of x."""
    power, head, tail = parts(x)
    return scaled(head + tail, power)
