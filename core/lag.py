r"""A lag of the first order over a stretch of time: its decay, and the moments of the decay."""

from __future__ import annotations

from core.elementary import exp
from core.kernel import kernel

TERMS = 24
"""Terms of the series of a moment for a decay no faster than 1: the next is below 1/24!, 1.6e-24."""


@kernel
def moments_of_decay(z: float) -> tuple[float, float, float, float, float]:
    r"""Return :math:`E_k=\int_0^1a^ke^{-za}da` for k from 0 to 3, then :math:`e^{-z}`.

    .. math:: zE_k=kE_{k-1}-e^{-z},\qquad zE_0=1-e^{-z}

    upwards for a fast decay. For a slow decay the differences would lose their digits: then downwards, from the series
    of the last.
    """
    rest = exp(-z)
    if z >= 1.0:
        first = (1.0 - rest) / z
        second = (first - rest) / z
        third = (2.0 * second - rest) / z
        fourth = (3.0 * third - rest) / z
    else:
        fourth = 0.0
        term = 1.0
        for n in range(TERMS):
            fourth += term / (n + 4.0)
            term *= -z / (n + 1.0)
        third = (z * fourth + rest) / 3.0
        second = 0.5 * (z * third + rest)
        first = z * second + rest
    return first, second, third, fourth, rest
