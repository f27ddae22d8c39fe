"""Probabilities from logarithms, and a floor under them."""

from __future__ import annotations

from core.elementary import exp, log
from core.kernel import SMALL, kernel, whole
from core.record import Vector

LEAST_LOG = log(SMALL)
"""Logarithm below which a share counts as nothing."""


def floored(floor: float) -> list[float]:
    """Pack a floor under probabilities and its logarithm; a floor of 0 means none, and its logarithm is not used."""
    return [floor, log(floor) if floor > 0.0 else 0.0]


@kernel
def shrunk(logarithm: float) -> float:
    """Return the number with this logarithm, or 0 for the smallest: a processor is ten times slower with underflow."""
    number = exp(LEAST_LOG if logarithm < LEAST_LOG else logarithm)
    return 0.0 if logarithm < LEAST_LOG else number


@kernel
def winner_of(probability: Vector, n: int) -> int:
    """Return the hypothesis with the largest probability, or the first of several with the same."""
    winner, most = 0, probability[0]
    for i in range(1, n):
        if probability[i] > most:
            winner, most = i, probability[i]
    return winner


@kernel
def take_floored_softmax(
    logs: Vector, likelihood: Vector, probability: Vector, n: int, best: float, floor: float, log_floor: float
) -> None:
    r"""Turn unnormalised logarithms into probabilities, :math:`p_k=\max(\mathrm{softmax}_k\,\ell,\;p_{min})`.

    Parameters
    ----------
    logs, likelihood : vectors
        Where the logarithms go, normalised as before the floor, and the logarithms of this sample.
    probability : vector
        Where the probabilities go.
    n : int
        Number of hypotheses.
    best : float
        Largest of the logarithms of this sample.
    floor, log_floor : float
        Smallest probability, 0 for none, and its logarithm.
    """
    total = 0.0
    for i in range(whole(n)):
        logs[i] = shrunk(likelihood[i] - best)
    for i in range(n):
        total += logs[i]
    after = 0.0
    inverse = 1.0 / total
    for i in range(n):
        share = max(logs[i] * inverse, floor)
        probability[i] = share
        after += share
    shift = best + log(total)
    inverse = 1.0 / after
    for i in range(n):
        share = probability[i]
        floored = floor > 0.0 and share == floor
        logs[i] = log_floor if floored else likelihood[i] - shift
        probability[i] = share * inverse
    for i in range(n, whole(n)):  # they would grow beyond all bounds
        logs[i] = 0.0


@kernel
def take_softmax(likelihood: Vector, probability: Vector, n: int, best: float) -> None:
    """Turn unnormalised logarithms into probabilities, and store no logarithms."""
    total = 0.0
    for i in range(n):
        share = shrunk(likelihood[i] - best)
        probability[i] = share
        total += share
    for i in range(n):
        probability[i] /= total
