"""How much a drive tells: evidence per sample between a winner and its nearest rival."""

from __future__ import annotations

from typing import Any

from core.block import inlined, settled
from core.diagnose.filters import INVERSE, MEMORY, OWN, RESIDUAL
from core.diagnose.lanes import LANE
from core.diagnose.weights import likeliest

LEAST_INFORMATION = 1e-3
"""Nats per sample below which thousands of samples do not repay the odds of a probability floor."""


@inlined
def nearest_rival(p: Any, s: Any, separation: int, n: int, w: Any, probability: int) -> float:
    r"""Return the evidence per sample against the nearest rival of the winner, in nats.

    .. math:: D=\min_{k\neq j}\frac{\overline{(\hat y_k-\hat y_j)^2}}{2\psi_k}

    is what the log-odds of two hypotheses grow by when one is true (Bar-Shalom, Li and Kirubarajan 2001, 11.6); the
    mean is taken over the shuttle's own memory. Both have the same measurement, so the difference of their residuals
    is that of their predictions.
    """
    winner = likeliest(w, probability, n)
    own = s[OWN + RESIDUAL * LANE + winner]
    nearest = 1e300
    for i in range(n):
        apart = s[OWN + RESIDUAL * LANE + i] - own
        gain = 0.5 * apart * apart * s[OWN + INVERSE * LANE + i]
        mean = p[MEMORY] * s[separation + i] + (1.0 - p[MEMORY]) * gain
        s[separation + i] = settled(mean)
        if i != winner and mean < nearest:
            nearest = mean
    return nearest
