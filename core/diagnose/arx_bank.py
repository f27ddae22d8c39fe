"""Difference equations identified beforehand, weighed like the filters of a Kalman bank."""

from __future__ import annotations

import math
from typing import Any

from core.block import Equation, Stage, parameter
from core.diagnose.arx import (
    REGRESSOR,
    ArxParams,
    WeighedBank,
    between_updates,
    gather_voltage,
    judge,
    predicted,
    regress,
)
from core.diagnose.weights import take_floored_softmax


class FixedBank(WeighedBank):
    r"""Banks that were tuned beforehand, each to its own sub-system, and are fixed now.

    .. math:: r_k=z_i-h_i^T\theta_k,\qquad R_e=\sigma^2(1+a_1^2+a_2^2)

    The bank has neither forgetting nor a filter: it works at 10 to 20 kHz and is lost in noise at 50.
    """

    title = "Bank of difference equations"
    weaknesses = (
        "Under one sine below 1 kHz noise decides more than the device: over the seven steps of 5.2.4, at 20 kHz and "
        "10 nm, it is right for over 99 % of the samples at 2 kHz, 89 % at 1 kHz, 74 % at 500 Hz and 33 % at 200 Hz.",
        "With 50 nm of noise it is right for 97 % at 2 kHz and 29 % at 1 kHz; IMM is right for 92 % there.",
    )
    equations = (Equation("residual", r"r_k=z_i-h_i^T\theta_k", "5.3.3.10, theta identified beforehand"),)
    structure = (
        REGRESSOR,
        Stage("Residuals", "h measured", "residual nis", ("residual",)),
        Stage("Likelihoods", "log nis", "likelihood"),
        Stage("Weights", "likelihood", "log probability"),
    )

    class Params(ArxParams):
        """Noise and floor."""

        probability_floor: float = parameter(1e-3, "smallest probability", equation="5.2.3.2.6", ge=0, le=0.05)
        prefilter: bool = parameter(False, "pass both signals through 1/A(q) of the healthy device", live=False)

    @classmethod
    def filters_signals(cls, params: Any) -> bool:
        """Say whether voltage and measurement pass the filter 1/A(q) of the healthy device."""
        return bool(params.prefilter)

    @staticmethod
    def step(p: WeighedBank.Packed, s: WeighedBank.State, x: WeighedBank.Ports) -> None:
        """Weigh every hypothesis by the error of its difference equation."""
        gather_voltage(p, s, x)
        if between_updates(p, x):
            return
        n = int(p.count)
        z = regress(p, s, x)
        best = -math.inf
        for i in range(n):
            residual = z - predicted(p, s.h, i)
            best = max(best, judge(p, s, x, i, residual))
        take_floored_softmax(s.log, s.likelihood, x.probability, n, best, p.floor, p.log_floor)
