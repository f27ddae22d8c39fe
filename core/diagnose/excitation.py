"""Information in a drive: evidence per sample between a winner and its nearest rival."""

from __future__ import annotations

from core.block import Stage
from core.diagnose.lanes import Filters, PackedFilters
from core.diagnose.weights import winner_of
from core.kernel import flush_tiny, kernel, whole
from core.record import Vector

EVIDENCE = Stage("Evidence of a sample", "probability", "information unexcited")
LEAST_INFORMATION = 1e-3
"""Nats per sample below which thousands of samples do not repay the odds of a probability floor."""


@kernel
def nearest_rival(p: PackedFilters, s: Filters, separation: Vector, probability: Vector, n: int) -> float:
    r"""Return the evidence per sample against the nearest rival of the winner, in nats.

    .. math:: D=\min_{k\neq j}\frac{\overline{(\hat y_k-\hat y_j)^2}}{2\psi_k}

    The log-odds of two hypotheses grow by D per sample when one of them is true (Bar-Shalom, Li and Kirubarajan 2001,
    11.6). The mean is taken over the shuttle's own memory. Both see the same measurement, so the difference of their
    residuals is the difference of their predictions.
    """
    winner = winner_of(probability, n)
    of_winner = s.residual[winner]
    nearest = 1e300
    for i in range(whole(n)):
        apart = s.residual[i] - of_winner
        gain = 0.5 * apart * apart * s.inverse[i]
        mean = p.memory * separation[i] + (1.0 - p.memory) * gain
        separation[i] = flush_tiny(mean)
    for i in range(n):
        if i != winner and separation[i] < nearest:
            nearest = separation[i]
    return nearest
