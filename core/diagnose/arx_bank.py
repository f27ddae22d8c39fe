"""Difference equations identified beforehand, weighed like the filters of a Kalman bank."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, parameter
from core.diagnose.arx import (
    COUNT,
    LANES,
    OWN,
    PROBABILITY,
    WIDTH,
    ArxBank,
    ArxParams,
    gathers,
    judge,
    regress,
    said,
)
from core.diagnose.weights import floored, weigh

FLOOR, LOG_FLOOR = range(2)
H, LOG = OWN, OWN + 4


def arx_bank_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Weigh every hypothesis by the error of its difference equation."""
    if gathers(p, s, w, io):
        return
    n = int(p[COUNT])
    own = LANES + WIDTH * n
    z = regress(p, s, w, io, H)
    best = -math.inf
    for i in range(n):
        residual = z - said(p, s, H, i, n)
        best = max(best, judge(p, s, w, io, LOG, i, n, residual))
    weigh(s, LOG, LOG + n, w, io[PROBABILITY], n, best, p[own + FLOOR], p[own + LOG_FLOOR])


class FixedBank(ArxBank):
    r"""Banks that were tuned beforehand, each to its own sub-system, and are fixed now.

    .. math:: r_k=z_i-h_i^T\theta_k,\qquad R_e=\sigma^2(1+a_1^2+a_2^2)

    No forgetting is left in it, and nothing of a filter either: good at 10 to 20 kHz, lost in noise at 50.
    """

    title = "Bank of difference equations"
    weaknesses = (
        "Under one sine below 1 kHz noise decides more than the device: over the seven steps of 5.2.4, at 20 kHz and "
        "10 nm, it is right for over 99 % of the samples at 2 kHz, 89 % at 1 kHz, 74 % at 500 Hz and 33 % at 200 Hz.",
        "With 50 nm of noise it is right for 97 % at 2 kHz and 29 % at 1 kHz; IMM is right for 92 % there.",
    )
    equations = (Equation("residual", r"r_k=z_i-h_i^T\theta_k", "5.3.3.10, theta identified beforehand"),)

    class Params(ArxParams):
        """Noise and floor."""

        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        prefilter: bool = parameter(False, "pass both signals through 1/A(q) of the healthy device", live=False)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array([*cls.equations_of(params, context), *floored(params.probability_floor)])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """At rest, all hypotheses alike."""
        n = len(params.hypotheses)
        return np.array([0.0] * LOG + [-math.log(n)] * n + [0.0] * n)

    step = arx_bank_step
