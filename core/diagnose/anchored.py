"""Self-tuning banks anchored to their hypotheses."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, kernel, parameter, settled
from core.diagnose.arx import COUNT, LANES, OWN, PROBABILITY, WIDTH, ArxBank, ArxParams, gathers, judge, regress
from core.diagnose.weights import floored, weigh

FORGETTING, ANCHOR, FLOOR, LOG_FLOOR = range(4)
"""Parameters of its own."""
H, INFORMATION, TARGET, FACTOR, RIGHT, LOG = OWN, OWN + 4, OWN + 14, OWN + 18, OWN + 28, OWN + 32
"""State: regressor, sums of h h' and of h z, factors of the matrix, a right-hand side; then logarithms."""


@kernel
def factorise(s: Any, a: int, anchor: float, d: int) -> None:
    r"""Factorise :math:`A+\rho I=LDL^T`, lower triangles row by row; D takes the place of the ones of L."""
    for i in range(4):
        row = d + i * (i + 1) // 2
        for j in range(i):
            column = d + j * (j + 1) // 2
            total = s[a + i * (i + 1) // 2 + j]
            for k in range(j):
                total -= s[row + k] * s[column + k] * s[d + k * (k + 1) // 2 + k]
            s[row + j] = total / s[column + j]
        total = s[a + i * (i + 1) // 2 + i] + anchor
        for k in range(i):
            total -= s[row + k] * s[row + k] * s[d + k * (k + 1) // 2 + k]
        s[row + i] = total


@kernel
def solve(s: Any, d: int, x: int) -> None:
    """Solve L D L' x = x in place."""
    for i in range(4):
        row = d + i * (i + 1) // 2
        for k in range(i):
            s[x + i] -= s[row + k] * s[x + k]
    for i in range(4):
        s[x + i] /= s[d + i * (i + 1) // 2 + i]
    for i in range(3, -1, -1):
        for k in range(i + 1, 4):
            s[x + i] -= s[d + k * (k + 1) // 2 + i] * s[x + k]


def anchored_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Let every bank say what it expects, weigh, and learn from the sample."""
    if gathers(p, s, w, io):
        return
    n = int(p[COUNT])
    own = LANES + WIDTH * n
    z = regress(p, s, w, io, H)
    anchor = p[own + ANCHOR]
    factorise(s, INFORMATION, anchor, FACTOR)
    # all banks share the matrix: h' theta_k = (h' V)(b + rho theta_k), one solution serves them all
    for j in range(4):
        s[RIGHT + j] = s[H + j]
    solve(s, FACTOR, RIGHT)
    common = z
    for j in range(4):
        common -= s[RIGHT + j] * s[TARGET + j]
    best = -math.inf
    for i in range(n):
        at = LANES + i
        pull = s[RIGHT] * p[at] + s[RIGHT + 1] * p[at + n]
        pull += s[RIGHT + 2] * p[at + 2 * n] + s[RIGHT + 3] * p[at + 3 * n]
        residual = common - anchor * pull
        best = max(best, judge(p, s, w, io, LOG, i, n, residual))
    weigh(s, LOG, LOG + n, w, io[PROBABILITY], n, best, p[own + FLOOR], p[own + LOG_FLOOR])
    forgetting = p[own + FORGETTING]
    for i in range(4):
        for j in range(i + 1):
            k = INFORMATION + i * (i + 1) // 2 + j
            s[k] = settled(forgetting * s[k] + s[H + i] * s[H + j])
        s[TARGET + i] = settled(forgetting * s[TARGET + i] + s[H + i] * z)


class Anchored(ArxBank):
    r"""Each bank estimates, held to its hypothesis as by a spring, and is weighed by what it predicts.

    .. math:: \hat\theta_k=\arg\min_\theta\sum_j\lambda^{i-j}(z_j-h_j^T\theta)^2+\rho|\theta-\theta_k|^2
        =(A+\rho I)^{-1}(b+\rho\theta_k)

    The one reading of the self-tuning banks that has the pattern of the text: the larger the forgetting factor, the
    more the data outweigh the anchor, and the more alike, and useless, the banks become. That order holds for every
    anchor; at which factor it goes wrong is set by the weight of the anchor, which the text does not give.
    """

    title = "Anchored self-tuning banks"
    weaknesses = (
        "Under one sine below 1 kHz noise decides more than the device: over the seven steps of 5.2.4, at 20 kHz and "
        "10 nm, it is right for 98 % of the samples at 2 kHz, 72 % at 1 kHz, 70 % at 500 Hz and 22 % at 200 Hz.",
        "With 50 nm of noise it is right for 57 % at 2 kHz and 18 % at 1 kHz; IMM is right for 92 % there.",
    )
    equations = (
        Equation("anchored estimate", r"\hat\theta_k=(A+\rho I)^{-1}(b+\rho\theta_k)", "a reading of 5.3.3"),
        Equation("residual", r"r_k=z_i-h_i^T\hat\theta_k", "5.3.3.10"),
    )

    class Params(ArxParams):
        """Memory, anchor and floor."""

        forgetting: float = parameter(0.86, "forgetting factor", equation="5.3.3.8", ge=0.5, le=0.9999)
        anchor: float = parameter(100.0, "weight rho of the hypothesis", gt=0, le=1e9)
        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        own = [params.forgetting, params.anchor, *floored(params.probability_floor)]
        return np.array(cls.equations_of(params, context) + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Nothing learnt, all hypotheses alike."""
        n = len(params.hypotheses)
        return np.array([0.0] * LOG + [-math.log(n)] * n + [0.0] * n)

    step = anchored_step
