"""Leakage, projection and Lyapunov function of the laws that adapt gains along a regressor."""

from __future__ import annotations

import math

from core.control.controller import NormalisedPacked
from core.kernel import kernel
from core.record import Vector

REGRESSORS = ("r", "w1", "w2", "y")
"""Signals that the gains of direct MRAC multiply."""
W2, Y = REGRESSORS.index("w2"), REGRESSORS.index("y")


class AdaptationPacked(NormalisedPacked):
    """Sample interval, coefficients, sign of the gain, gain g of the adaptation, leakage and bound of the gains."""

    sign: float
    adaptation_gain: float
    leakage: float
    gain_bound: float


@kernel
def weight_of(i: int, weight: float) -> float:
    """Return the adaptation weight of a regressor: w2 and y are micrometres, the others volts."""
    return weight if i == W2 or i == Y else 1.0


@kernel
def leak(p: AdaptationPacked, theta: float) -> float:
    """Return how much of a gain leaks away in a sample."""
    return p.h * p.leakage * p.adaptation_gain * theta


@kernel
def bounded(p: AdaptationPacked, theta: float, weight: float) -> float:
    """Return a gain within its bound: a projection onto a box scaled like the adaptation weights."""
    if p.gain_bound > 0.0:
        bound = p.gain_bound * math.sqrt(weight)
        theta = min(max(theta, -bound), bound)
    return theta


@kernel
def distance(gains: Vector, ideal: Vector, n: int, weight: float) -> float:
    r"""Return :math:`\phi^T\Gamma^{-1}\phi` of a Lyapunov function, with :math:`\phi` the gains less the ideal ones."""
    total = 0.0
    for i in range(n):
        phi = gains[i] - ideal[i]
        total += phi * phi / weight_of(i, weight)
    return total
