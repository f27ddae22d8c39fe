"""The bits of a number as an integer and back, and sums and products with what rounding took off."""

from __future__ import annotations

from core.compile.instructions import bits_of, number_of
from core.kernel import kernel

__all__ = ["bits_of", "number_of", "product_error", "sum_error"]

SPLITTER = 134217729.0
"""2^27 + 1: parts a number into halves whose products are exact (Veltkamp 1968)."""


@kernel
def sum_error(a: float, b: float, total: float) -> float:
    r"""Return what rounding took off a sum: :math:`a+b-\mathrm{fl}(a+b)`, exactly (Knuth, TAOCP 2, 4.2.2)."""
    part = total - a
    return (a - (total - part)) + (b - part)


@kernel
def product_error(a: float, b: float, product: float) -> float:
    r"""Return what rounding took off a product: :math:`ab-\mathrm{fl}(ab)`, exactly (Dekker 1971)."""
    spread = SPLITTER * a
    a_high = spread - (spread - a)
    a_low = a - a_high
    spread = SPLITTER * b
    b_high = spread - (spread - b)
    b_low = b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low
