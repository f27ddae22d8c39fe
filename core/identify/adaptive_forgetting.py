"""Recursive least squares whose forgetting factor follows the innovations."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Context, Equation, Stage, parameter
from core.estimation import estimate
from core.identify.discrete import Discrete, DiscreteParams, N, gather_voltage, nominal, observe, report
from core.identify.identifier import DEVICE, JUDGED, between_updates
from core.kernel import kernel
from core.ports import tap
from core.record import Choice

READINGS = ("direct", "step", "printed")
DIRECT, STEPWISE, PRINTED = 0.0, 1.0, 2.0
"""Readings of 5.4 as numbers."""
HUGE = 1e30
"""Bound of a ratio that would grow without end."""


@kernel
def spread(s: Discrete.State) -> float:
    """Return h' eta h."""
    total = 0.0
    for i in range(N):
        for j in range(N):
            low, high = min(i, j), max(i, j)
            total += s.phi[i] * s.covariance[high * (high + 1) // 2 + low] * s.phi[j]
    return total


@kernel
def adapt(p: AdaptiveForgetting.Packed, s: AdaptiveForgetting.State, e: float) -> None:
    r"""Choose the forgetting factor of this sample.

    If the innovations exceed :math:`1+h^T\eta h/\lambda` times the variance of the noise, the law trusts its estimate
    too much; the factor :math:`\tilde\lambda=h^T\eta h/(R-1)` would explain them.
    """
    square = e * e
    before = s.forgetting
    memory = p.memory if p.mode == DIRECT else before
    if p.mode == PRINTED:
        weight = 1.0 + before * s.weight
        s.ratio = min((before * s.ratio + square) / (weight * p.variance), HUGE)
    else:
        weight = 1.0 + memory * s.weight
        s.ratio = (memory * s.weight * s.ratio + square / p.variance) / weight
    s.weight = weight
    information = spread(s)
    if p.mode == DIRECT:
        s.forgetting = 1.0
        if s.ratio > p.gate:
            s.forgetting = min(max(information / (s.ratio - 1.0), p.least_forgetting), 1.0)
        return
    wanted = (before + information) / max(s.ratio, 1.0 / HUGE)
    moved = before + (p.step_size if wanted > before else -p.step_size if wanted < before else 0.0)
    if p.mode == PRINTED:
        s.forgetting = max(moved, p.least_forgetting)
    else:
        s.forgetting = min(max(moved, p.least_forgetting), 1.0)


class AdaptiveForgetting(Discrete):
    r"""Recursive least squares that forgets when its innovations say so (5.4.1).

    .. math:: R_i=\frac{\rho\gamma_{i-1}R_{i-1}+w_i^2/\sigma^2}{\gamma_i},\;\gamma_i=1+\rho\gamma_{i-1},\quad
        \lambda_i=\mathrm{clip}\Big(\frac{h^T\eta h}{R_i-1},\lambda_{min},1\Big)
        \text{ while }R_i>R_{gate},\text{ else }1

    with :math:`w_i` the innovation and :math:`\sigma^2` the variance it would have with a perfect estimate. As printed
    the scheme ignores the data: its ratio goes to infinity where the noise is small in its units, or to
    zero where it is large, and the factor just walks down or up by mu per sample.
    """

    title = "Least squares, adaptive forgetting"
    equations = (
        Equation(
            "innovation",
            r"R_i=\frac{\rho\gamma_{i-1}R_{i-1}+w_i^2/\sigma^2}{\gamma_i}",
            "5.4.1.3-5",
            printed=r"\hat R_i=\frac{1}{\sigma_\omega^2}\frac{\lambda_{i-1}\hat R_{i-1}+w_kw_k^*}{\gamma_i}",
            why="without gamma inside and with sigma outside the recursion it forgets the data or explodes; w is the "
            "innovation, not the noise",
        ),
        Equation(
            "forgetting factor",
            r"\tilde\lambda_i=\frac{h^T\eta h}{R_i-1}",
            "5.4.6",
            printed=r"\lambda_i=\frac{\lambda_{i-1}(1+H_iP'_{i-1}H_i^T)}{\hat R_i}",
            why="this one is right in steady state, since then R = 1 + h'eta h / lambda, but slow on the way",
        ),
        Equation(
            "limit",
            r"\lambda_i=\mathrm{clip}(\lambda_{i-1}+\mu\,\mathrm{sgn}(\tilde\lambda_i-\lambda_{i-1}),\lambda_{min},1)",
            "5.4.7",
            printed=r"\lambda_i=\lambda_{i-1}+\mu\,\mathrm{sgn}(\lambda_i-\lambda_{i-1})",
            why="a sign bounds the step and not the factor, and one symbol cannot be on both sides",
        ),
    )
    structure = (
        Stage("Regressor", "applied measured", "phi"),
        Stage("Residual", "coefficient phi measured", "residual"),
        Stage("Innovation", "residual", "innovation_ratio", ("innovation",)),
        Stage("Forgetting", "innovation_ratio phi", "forgetting", ("forgetting factor", "limit")),
        Stage("Covariance", "phi forgetting", "covariance covariance_trace"),
        Stage("Estimator", "residual phi covariance", "coefficient"),
        DEVICE,
        JUDGED,
    )

    class Params(DiscreteParams):
        """Reading, variance and limits, in um and V."""

        reading: Literal["direct", "step", "printed"] = parameter(
            "direct", "set the factor at once, step towards it (corrected), or as printed", equation="5.4.7"
        )
        innovation_um: float | None = parameter(
            None,
            "standard deviation of the innovation of a perfect estimate; from the sensor's noise unless given",
            "um",
            equation="5.4.1.1",
            gt=0,
            le=100,
        )
        memory_samples: float = parameter(3.0, "samples the ratio R looks back", "samples", ge=1, le=1e6)
        gate: float = parameter(5.0, "ratio R above which it forgets", equation="5.4.6", ge=1, le=1e6)
        least_forgetting: float = parameter(0.2, "smallest forgetting factor", "1", gt=0.01, le=1)
        step_size: float = parameter(1e-4, "step mu of the other readings", equation="5.4.7", gt=0, le=1)

    class Packed(Discrete.Packed):
        """Reading, variance of the innovation, memory of the ratio, and limits."""

        mode: Choice
        variance: float
        memory: float
        gate: float
        least_forgetting: float
        step_size: float

    class State(Discrete.State):
        """Forgetting factor, ratio R and the weight of the samples in it."""

        forgetting: float
        ratio: float
        weight: float

    class Ports(Discrete.Ports):
        """How much it forgets, and why."""

        forgetting: float = tap("1", "forgetting factor of this sample")
        innovation_ratio: float = tap("1", "mean squared innovation over what noise alone would give, R")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        deviation = params.innovation_um
        if deviation is None:
            # one residual contains the noise of three samples
            *_, a1, a2 = nominal(context.device, context.dt_ms)
            deviation = max(context.sensor_noise_um, 1e-3) * (1.0 + a1 * a1 + a2 * a2) ** 0.5
        p = cls.Packed.blank()
        cls.fill_sampled(p, params, context)
        p.mode = float(READINGS.index(params.reading))
        p.variance = deviation**2
        p.memory = 1.0 - 1.0 / params.memory_samples
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Estimate and covariance at the start, factor 1, no samples yet."""
        s = cls.State.zeros()
        cls.fill_start(s, params, context)
        s.forgetting = 1.0
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Predict, compare, choose how much to forget, update estimate and covariance."""
        gather_voltage(p, s, x)
        if between_updates(p, x):
            return
        use, e = observe(p, s, x)
        if use:
            adapt(p, s, e)
            estimate(s.theta, s.covariance, s.phi, s.product, N, e, s.forgetting, s.forgetting, p.covariance_limit)
        report(p, s, x, e)
        x.forgetting = s.forgetting
        x.innovation_ratio = s.ratio
