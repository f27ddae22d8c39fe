"""Sine and cosine."""

from __future__ import annotations

from core.elementary.bits import bits_of, product_error, sum_error
from core.elementary.rounding import MAGIC
from core.kernel import kernel

PER_QUARTER = 6.36619772367581382433e-01
QUARTER_1, QUARTER_2, QUARTER_3, QUARTER_4 = (
    1.57079632673412561417e00,
    6.07710050630396597660e-11,
    2.02226624871116645580e-21,
    8.47842766036889956997e-32,
)
r""":math:`\pi/2` in pieces of 33 bits, so that their products with a whole number below 2^20 are exact."""
TURN_HIGH, TURN_LOW = 6.28318530717958623200, 2.44929359829470635446e-16
S1, S2, S3 = -1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04
S4, S5, S6 = 2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10
C1, C2, C3 = 4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05
C4, C5, C6 = -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11


@kernel
def reduced(angle: float) -> tuple[int, float, float]:
    r"""Return the quarter turns k of an angle and the rest in two parts: :math:`x=k\pi/2+r+t`, :math:`|r|\le\pi/4`.

    Exact to the last place of the sine up to 2^20 quarter turns, 1.6 million; a larger angle loses places.
    """
    shifted = angle * PER_QUARTER + MAGIC
    count = shifted - MAGIC
    first = angle - count * QUARTER_1
    second = first - count * QUARTER_2
    third = second - count * QUARTER_3
    low = sum_error(first, -count * QUARTER_2, second) + sum_error(second, -count * QUARTER_3, third)
    low -= count * QUARTER_4
    r = third + low
    return bits_of(shifted) & 3, r, (third - r) + low


@kernel
def sine(x: float, tail: float) -> float:
    """Return the sine of x + tail in an eighth of a turn (fdlibm, Sun Microsystems 1993, k_sin)."""
    z = x * x
    cube = z * x
    r = S2 + z * (S3 + z * S4) + z * z * z * (S5 + z * S6)
    return x - ((z * (0.5 * tail - cube * r) - tail) - cube * S1)


@kernel
def cosine(x: float, tail: float) -> float:
    """Return the cosine of x + tail in an eighth of a turn (fdlibm, Sun Microsystems 1993, k_cos)."""
    z = x * x
    w = z * z
    r = z * (C1 + z * (C2 + z * C3)) + w * w * (C4 + z * (C5 + z * C6))
    half = 0.5 * z
    head = 1.0 - half
    return head + (((1.0 - head) - half) + (z * r - x * tail))


@kernel
def sin_of_turns(turns: float) -> float:
    r"""Return :math:`\sin 2\pi\phi` of a phase in turns, below 2^50 in size: whole turns go off without rounding."""
    shifted = 4.0 * turns + MAGIC
    rest = turns - 0.25 * (shifted - MAGIC)
    r = TURN_HIGH * rest
    tail = product_error(TURN_HIGH, rest, r) + TURN_LOW * rest
    quarter = bits_of(shifted) & 3
    value = cosine(r, tail) if quarter & 1 else sine(r, tail)
    return (-value if quarter & 2 else value) + 0.0  # not minus zero at half a turn


@kernel
def sin(x: float) -> float:
    """Return the sine of an angle in rad, up to 1.6 million in size."""
    quarter, r, tail = reduced(x)
    value = cosine(r, tail) if quarter & 1 else sine(r, tail)
    value = -value if quarter & 2 else value
    return x if x == 0.0 else value


@kernel
def cos(x: float) -> float:
    """Return the cosine of an angle in rad, up to 1.6 million in size."""
    quarter, r, tail = reduced(x)
    value = sine(r, tail) if quarter & 1 else cosine(r, tail)
    return -value if (quarter + 1) & 2 else value
