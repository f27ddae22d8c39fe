"""Self-tuning estimator: recursive least squares on the device, compared with every hypothesis."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Context, Equation, Stage, parameter
from core.diagnose.arx import (
    SIZE,
    ArxBank,
    ArxParams,
    between_updates,
    driven,
    gather_voltage,
    predicted,
    regress,
    unexplained,
)
from core.diagnose.lanes import LANE
from core.diagnose.weights import take_softmax
from core.estimation import diagonal, entry, estimate, trace_of, triangle
from core.kernel import flush_tiny, kernel
from core.ports import tap
from core.record import Choice, Vector, vector

MODES = ("fixed", "direct", "stepped", "printed")
FIXED, DIRECT, STEPPED, PRINTED = 0.0, 1.0, 2.0, 3.0
"""Codes of the ways to set the forgetting factor."""
HUGE = 1e300
"""Bound of the printed recursion, which would grow without end."""


@kernel
def quadratic(covariance: Vector, h: Vector, n: int) -> float:
    """Return h' P h."""
    total = 0.0
    for i in range(n):
        row = 0.5 * covariance[entry(i, i)] * h[i]
        for j in range(i):
            row += covariance[entry(i, j)] * h[j]
        total += 2.0 * row * h[i]
    return float(total)


@kernel
def adapted(p: SelfTuning.Packed, s: SelfTuning.State, innovation: float, gain: float) -> float:
    """Return the forgetting factor for this sample."""
    before = s.forgetting
    normalised = innovation * innovation / p.noise_variance
    if p.mode == DIRECT:
        # R over a short window, and the factor that makes 1 + h'eta h/lambda equal to it
        share = 1.0 / p.innovation_window
        s.ratio = flush_tiny((1.0 - share) * s.ratio + share * normalised)
        if s.ratio <= p.gate:
            return 1.0
        return float(min(max(gain / max(s.ratio - 1.0, 1e-12), p.least_forgetting), 1.0))
    s.weight = 1.0 + before * s.weight
    last = s.ratio
    if p.mode == STEPPED:
        s.ratio = flush_tiny(((s.weight - 1.0) * last + normalised) / s.weight)
    else:
        s.ratio = min((before * last + innovation * innovation) / (s.weight * p.noise_variance), HUGE)
    target = before * (1.0 + gain / before) / max(s.ratio, 1e-300)
    moved = before + (p.forgetting_step if target > before else -p.forgetting_step if target < before else 0.0)
    if p.mode == STEPPED:
        return float(min(max(moved, p.least_forgetting), 1.0))
    return float(min(max(moved, 1e-3), 2.0))


class SelfTuning(ArxBank):
    r"""Recursive least squares with forgetting on the device; a hypothesis is likely when the estimate is near it.

    .. math:: L_k=\exp\Bigl(-\frac{(\hat\theta-\theta_k)^T\eta^{-1}(\hat\theta-\theta_k)}{2s^2}\Bigr),\qquad
        (\hat\theta-\theta_k)^T\eta^{-1}(\hat\theta-\theta_k)=J(\theta_k)-J(\hat\theta),\quad
        J(\theta)=\sum_j\lambda^{i-j}(z_j-h_j^T\theta)^2

    Nearness is measured in the metric of the information: one sine and white noise determine two numbers of the four,
    so the plain distance between coefficients means nothing. Costs over the same memory give the same likelihoods, and
    the bank computes these.

    Voltage and measurement may pass 1/A(q) of the healthy device first, which makes the error of the equation white.
    Without that filter the method works at 10 to 20 kHz.

    The forgetting factor is fixed, or follows the innovations. ``direct`` solves :math:`1+h^T\eta h/\lambda=R` for it
    if R, taken over a few samples, is beyond a gate; ``stepped`` is 5.4 corrected; ``printed`` is 5.4 unchanged, a ramp
    that ignores the data. ``R`` of the printed recursion ends at 1e300, where it would be infinite.
    """

    sample_by_sample = False
    title = "Self-tuning estimator"
    weaknesses = (
        "Under one sine below 1 kHz noise decides more than the device: over the seven steps of 5.2.4, at 20 kHz and "
        "10 nm, it is right for 99 % of the samples at 2 kHz, 91 % at 1 kHz, 67 % at 500 Hz and 41 % at 200 Hz.",
        "With 50 nm of noise it is right for 96 % at 2 kHz and 39 % at 1 kHz, where it takes the healthy device for "
        "another three times in four; IMM is right for 92 % there.",
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
            why="the same symbol is on both sides, and steps of 1e-4 make it the slowest of all; the sign does "
            "not bound it either",
        ),
    )
    structure = (
        Stage("Regressor", "applied measured", "h", ("difference equation",)),
        Stage("Power of the innovations", "estimate h measured", "innovation_ratio", ("power of the innovations",)),
        Stage("Forgetting", "innovation_ratio", "forgetting", ("adaptive forgetting",)),
        Stage("Identifier", "h measured forgetting", "estimate trace", ("estimate",)),
        Stage("Residuals of the models", "h measured", "residual nis", ("difference equation",)),
        Stage("Costs", "residual forgetting", "cost"),
        Stage("Weights", "cost", "probability"),
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

    class Packed(ArxBank.Packed):
        """Forgetting and how it adapts, limit of the covariance, variance of the equation error."""

        forgetting: float
        mode: Choice
        forgetting_step: float
        gate: float
        least_forgetting: float
        innovation_window: float
        trace_limit: float
        noise_variance: float

    class State(ArxBank.State):
        """Estimate, covariance, scratch; forgetting factor, R and gamma; costs and logarithms of the models."""

        theta: Vector = vector(SIZE)
        covariance: Vector = vector(triangle(SIZE))
        product: Vector = vector(SIZE)
        forgetting: float
        ratio: float
        weight: float
        cost: Vector = vector(LANE)
        likelihood: Vector = vector(LANE)

    class Ports(ArxBank.Ports):
        """The estimate and its forgetting factor."""

        estimate: Vector = tap("1", "estimated coefficients", labels=("b0", "b1", "a1", "a2"))
        forgetting: float = tap("1", "forgetting factor")
        innovation_ratio: float = tap("1", "R: power of the innovations over the power of the noise")
        trace: float = tap("1", "trace of the covariance")

    @classmethod
    def filters_signals(cls, params: Any) -> bool:
        """Say whether voltage and measurement pass the filter 1/A(q) of the healthy device."""
        return bool(params.prefilter)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        cls.fill_equations(p, params, context)
        p.mode = float(MODES.index(params.adaptation))
        p.noise_variance = params.noise_variance or p.variance[0]
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """No estimate and almost no information; no costs."""
        s = cls.State.zeros()
        s.covariance[:] = diagonal(SIZE, params.initial_covariance)
        s.forgetting = params.initial_forgetting
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Estimate, adapt the forgetting, weigh every hypothesis by its cost over the same memory."""
        gather_voltage(p, s, x)
        if between_updates(p, x):
            return
        n = int(p.count)
        z = regress(p, s, x)
        innovation = unexplained(s.theta, s.h, z)
        forgetting = p.forgetting
        if p.mode != FIXED:
            forgetting = adapted(p, s, innovation, quadratic(s.covariance, s.h, SIZE))
        s.forgetting = forgetting
        estimate(s.theta, s.covariance, s.h, s.product, SIZE, innovation, forgetting, forgetting, p.trace_limit)
        best = -math.inf
        evidence = driven(p, s)
        for i in range(n):
            error = z - predicted(p, s.h, i)
            cost = s.cost[i]
            if evidence:
                cost = flush_tiny(forgetting * cost + error * error)
            s.cost[i] = cost
            likelihood = -0.5 * cost / p.noise_variance
            s.likelihood[i] = likelihood
            best = max(best, likelihood)
            x.residual[i] = error
            x.nis[i] = error * error / p.variance[i]
        take_softmax(s.likelihood, x.probability, n, best)
        for j in range(SIZE):
            x.estimate[j] = s.theta[j]
        x.forgetting = forgetting
        x.innovation_ratio = s.ratio
        x.trace = trace_of(s.covariance, SIZE)
