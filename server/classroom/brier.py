"""Points for an answer that is given with a confidence, by Brier's rule."""

from __future__ import annotations


def points(right: bool, confidence: float, answers: int) -> float:
    r"""Return the points: 100 for right and sure, 0 for ignorance, fewer than 0 for a worse answer.

    .. math:: 100\left(1-\frac{n}{n-1}\sum_{i=1}^n(p_i-o_i)^2\right)

    The confidence is the probability of the answer, and the rest is spread evenly over the other answers; ``o`` is 1
    for the true answer and 0 for the others. Brier's score of even odds, :math:`1-1/n`, gives 0 points, as does no
    answer. The rule is proper: on average a player earns most with true probabilities.

    Parameters
    ----------
    right : bool
        Whether the answer is the true one.
    confidence : float
        0 to 1.
    answers : int
        How many answers there are, at least 2.

    References
    ----------
    Brier 1950, Verification of forecasts expressed in terms of probability, Monthly Weather Review 78.
    """
    rest = (1.0 - confidence) / (answers - 1)
    said = (1.0 - confidence if right else confidence) ** 2
    others = (answers - 1) * rest**2 if right else (1.0 - rest) ** 2 + (answers - 2) * rest**2
    return 100.0 * (1.0 - (said + others) * answers / (answers - 1))
