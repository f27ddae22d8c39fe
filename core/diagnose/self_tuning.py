"""Self-tuning estimator: recursive least squares on the device, compared with every hypothesis."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core import estimation
from core.block import Context, Equation, FloatArray, Port, kernel, parameter, settled
from core.diagnose.arx import (
    COUNT,
    LANES,
    OWN,
    PROBABILITY,
    SIZE,
    VARIANCE,
    WIDTH,
    ArxBank,
    ArxParams,
    driven,
    gathers,
    regress,
    said,
)
from core.diagnose.weights import share_out

FORGETTING, MODE, STEP, GATE, LEAST, WINDOW, LIMIT, NOISE = range(8)
"""Parameters of its own."""
H, THETA, COVARIANCE, PRODUCT = OWN, OWN + SIZE, OWN + 2 * SIZE, OWN + 2 * SIZE + 10
LAMBDA, RATIO, WEIGHT, COST = OWN + 3 * SIZE + 10, OWN + 3 * SIZE + 11, OWN + 3 * SIZE + 12, OWN + 3 * SIZE + 13
"""State: regressor, estimate, covariance, scratch; forgetting, R, gamma; then costs and logarithms of the models."""
RESIDUAL_TAP, NIS_TAP, ESTIMATE_TAP, FORGETTING_TAP, RATIO_TAP, TRACE_TAP = range(PROBABILITY + 1, PROBABILITY + 7)
FIXED, DIRECT, STEPPED, PRINTED = range(4)
MODES = ("fixed", "direct", "stepped", "printed")
HUGE = 1e300
"""Where the printed recursion, which grows beyond all bounds, is stopped so that it stays a number."""


@kernel
def quadratic(s: Any, covariance: int, h: int, n: int) -> float:
    """Return h' P h."""
    total = 0.0
    for i in range(n):
        row = 0.5 * s[covariance + estimation.entry(i, i)] * s[h + i]
        for j in range(i):
            row += s[covariance + estimation.entry(i, j)] * s[h + j]
        total += 2.0 * row * s[h + i]
    return float(total)


@kernel
def adapted(p: Any, own: int, s: Any, innovation: float, gain: float) -> float:
    """Return the forgetting factor for this sample."""
    before = s[LAMBDA]
    normalised = innovation * innovation / p[own + NOISE]
    mode = p[own + MODE]
    if mode == 1.0:
        # R over a short window, and the factor that makes 1 + h'eta h/lambda equal to it
        share = 1.0 / p[own + WINDOW]
        s[RATIO] = settled((1.0 - share) * s[RATIO] + share * normalised)
        if s[RATIO] <= p[own + GATE]:
            return 1.0
        return float(min(max(gain / max(s[RATIO] - 1.0, 1e-12), p[own + LEAST]), 1.0))
    s[WEIGHT] = 1.0 + before * s[WEIGHT]
    last = s[RATIO]
    if mode == 2.0:
        s[RATIO] = settled(((s[WEIGHT] - 1.0) * last + normalised) / s[WEIGHT])
    else:
        s[RATIO] = min((before * last + innovation * innovation) / (s[WEIGHT] * p[own + NOISE]), HUGE)
    target = before * (1.0 + gain / before) / max(s[RATIO], 1e-300)
    moved = before + (p[own + STEP] if target > before else -p[own + STEP] if target < before else 0.0)
    if mode == 2.0:
        return float(min(max(moved, p[own + LEAST]), 1.0))
    return float(min(max(moved, 1e-3), 2.0))


def self_tuning_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Estimate, adapt the forgetting, weigh every hypothesis by its cost over the same memory."""
    if gathers(p, s, w, io):
        return
    n = int(p[COUNT])
    own = LANES + WIDTH * n
    z = regress(p, s, w, io, H)
    innovation = z
    for j in range(SIZE):
        innovation -= s[H + j] * s[THETA + j]
    forgetting = p[own + FORGETTING]
    if p[own + MODE] != 0.0:
        forgetting = adapted(p, own, s, innovation, quadratic(s, COVARIANCE, H, SIZE))
    s[LAMBDA] = forgetting
    estimation.least_squares(s, THETA, COVARIANCE, H, PRODUCT, SIZE, innovation, forgetting, forgetting, p[own + LIMIT])
    best = -math.inf
    evidence = driven(p, s)
    for i in range(n):
        error = z - said(p, s, H, i, n)
        cost = s[COST + i]
        if evidence:
            cost = settled(forgetting * cost + error * error)
        s[COST + i] = cost
        log = -0.5 * cost / p[own + NOISE]
        s[COST + n + i] = log
        best = max(best, log)
        w[io[RESIDUAL_TAP] + i] = error
        w[io[NIS_TAP] + i] = error * error / p[LANES + VARIANCE * n + i]
    share_out(s, COST + n, w, io[PROBABILITY], n, best)
    for j in range(SIZE):
        w[io[ESTIMATE_TAP] + j] = s[THETA + j]
    w[io[FORGETTING_TAP]] = forgetting
    w[io[RATIO_TAP]] = s[RATIO]
    w[io[TRACE_TAP]] = estimation.trace(s, COVARIANCE, SIZE)


class SelfTuning(ArxBank):
    r"""Recursive least squares with forgetting on the device; a hypothesis is likely when the estimate is near it.

    .. math:: L_k=\exp\Bigl(-\frac{(\hat\theta-\theta_k)^T\eta^{-1}(\hat\theta-\theta_k)}{2s^2}\Bigr),\qquad
        (\hat\theta-\theta_k)^T\eta^{-1}(\hat\theta-\theta_k)=J(\theta_k)-J(\hat\theta),\quad
        J(\theta)=\sum_j\lambda^{i-j}(z_j-h_j^T\theta)^2

    Near in the metric of the information, that is: one sine and white noise pin down two numbers of the four, so
    distance between coefficients means nothing. Costs over the same memory give the same likelihoods, and are what
    is computed.

    Voltage and measurement may pass 1/A(q) of the healthy device first, which makes the error of the equation white:
    without it the method is for 10 to 20 kHz.

    The forgetting factor is fixed, or follows the innovations: ``direct`` solves :math:`1+h^T\eta h/\lambda=R` for it
    with R over a few samples, when R is beyond a gate; ``stepped`` is 5.4 corrected; ``printed`` is 5.4 as it stands,
    a ramp that does not look at the data. ``R`` of the printed recursion ends at 1e300, where it would be infinite.
    """

    sample_by_sample = False
    title = "Self-tuning estimator"
    weaknesses = (
        "Under one sine below 1 kHz noise decides more than the device: over the seven steps of 5.2.4, at 20 kHz and "
        "10 nm, it is right for 99 % of the samples at 2 kHz, 91 % at 1 kHz, 67 % at 500 Hz and 41 % at 200 Hz.",
        "With 50 nm of noise it is right for 96 % at 2 kHz and 39 % at 1 kHz, where it takes the healthy device for "
        "another three times in four; IMM is right for 92 % there.",
    )
    taps = (
        *ArxBank.taps,
        Port("estimate", "1", "estimated coefficients", labels=("b0", "b1", "a1", "a2")),
        Port("forgetting", "1", "forgetting factor"),
        Port("innovation_ratio", "1", "R: power of the innovations over that of the noise"),
        Port("trace", "1", "trace of the covariance"),
    )
    equations = (
        Equation("difference equation", r"z_{i+1}=b_0u_i+b_1u_{i-1}-a_1z_i-a_2z_{i-1}", "5.3.3.1, ARX"),
        Equation(
            "estimate",
            r"\hat\theta\leftarrow\hat\theta+\frac{\eta h}{\lambda+h^T\eta h}(z-h^T\hat\theta),\;"
            r"\eta\leftarrow\frac1\lambda\Bigl[\eta-\frac{\eta hh^T\eta}{\lambda+h^T\eta h}\Bigr]",
            "5.3.3.8-9",
            printed=r"\text{a higher forgetting factor means a shorter history}",
            why="the memory is 1/(1 - lambda) samples: 7 at 0.86, 10 at 0.9, 50 at 0.98",
        ),
        Equation(
            "power of the innovations",
            r"R_i=\frac{\lambda\gamma_{i-1}R_{i-1}+w_i^2/s^2}{\gamma_i},\quad\gamma_i=1+\lambda\gamma_{i-1}",
            "5.4.1.4",
            printed=r"\hat R_i=\frac{1}{\sigma_\omega^2}\frac{\lambda_{i-1}\hat R_{i-1}+w_kw_k^*}{\gamma_i}",
            why="divided by the variance at every step it grows without end or dies out, whatever is measured",
        ),
        Equation(
            "adaptive forgetting",
            r"\tilde\lambda=\frac{h^T\eta h}{R-1}",
            "5.4.6-7",
            printed=r"\lambda_i=\lambda_{i-1}+\mu\,\mathrm{sgn}(\lambda_i-\lambda_{i-1})",
            why="the same symbol stands on both sides, and steps of 1e-4 make it the slowest of all; the sign does "
            "not bound it either",
        ),
    )

    class Params(ArxParams):
        """Memory and noise."""

        forgetting: float = parameter(0.86, "forgetting factor", equation="5.3.3.8", ge=0.5, le=1)
        adaptation: Literal["fixed", "direct", "stepped", "printed"] = parameter(
            "fixed", "what becomes of the forgetting factor", equation="5.4"
        )
        initial_forgetting: float = parameter(
            1.0, "forgetting factor at the start, when it adapts", equation="5.4.2", ge=0.2, le=1, live=False
        )
        forgetting_step: float = parameter(
            1e-4, "step of the factor, mu; not for direct", equation="5.4.7", gt=0, le=0.5
        )
        gate: float = parameter(5.0, "R above which direct adaptation acts", ge=1, le=1000)
        least_forgetting: float = parameter(0.2, "smallest factor", ge=0.01, le=1)
        innovation_window: float = parameter(3.0, "samples of R of the direct adaptation", ge=1, le=1000)
        prefilter: bool = parameter(False, "pass both signals through 1/A(q) of the healthy device", live=False)
        noise_variance: float | None = parameter(
            None, "variance of the equation error, s^2; from the sensor noise unless given", "um^2", gt=0, le=1e6
        )
        initial_covariance: float = parameter(
            1e8, "covariance at the start, over unit matrix", equation="5.3.4.1", gt=0, le=1e12, live=False
        )
        trace_limit: float = parameter(1e10, "trace beyond which the covariance stays as it is", gt=0, le=1e100)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        packed = cls.equations_of(params, context)
        noise = params.noise_variance or packed[LANES + VARIANCE * len(params.hypotheses)]
        own = [
            params.forgetting,
            float(MODES.index(params.adaptation)),
            params.forgetting_step,
            params.gate,
            params.least_forgetting,
            params.innovation_window,
            params.trace_limit,
            noise,
        ]
        return np.array(packed + own)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """No estimate, as good as no information; no costs."""
        n = len(params.hypotheses)
        covariance = estimation.diagonal(SIZE, params.initial_covariance)
        start = [0.0] * (OWN + 2 * SIZE) + covariance + [0.0] * SIZE + [params.initial_forgetting, 0.0, 0.0]
        return np.array(start + [0.0] * (2 * n))

    step = self_tuning_step
