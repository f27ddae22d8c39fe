"""Direct model reference adaptive control, relative degree two."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.control.adaptation import REGRESSORS, AdaptationPacked, Y, bounded, distance, leak, weight_of
from core.control.controller import (
    ControllerPorts,
    Lag,
    TruthPorts,
    advance_lag,
    coefficients,
    fill_normalised,
    lag,
    matching,
    model_filter,
    true_plant,
    unsuited_second_order,
)
from core.kernel import flush_tiny
from core.ports import reads, tap
from core.record import Record, Records, Vector, several, vector
from core.voltage import Motion, Tick, add_moves, advance_motion, moves

LABELS = (*REGRESSORS, "bias")
CONSTANT, N = LABELS.index("bias"), len(LABELS)
"""The constant takes part only if it is not 0."""


class Mrac(Block):
    r"""Direct model reference adaptive control with augmented error (3.1.2.5-16).

    .. math:: u=\theta^Tw,\quad w=[r,w_1,w_2,y],\quad \dot w_1=-\lambda w_1+u,\;\dot w_2=-\lambda w_2+y

    .. math:: \eta=\theta^T\bar w-G_m[u],\;\bar w=G_m[w],\quad \varepsilon=e+\alpha\eta,\;e=y-y_m

    .. math:: \dot\theta=-\mathrm{sgn}(k_p/k_m)\,g\,\Gamma\frac{\varepsilon\bar w}{1+\bar w^T\Gamma\bar w+\eta^2},
        \quad \dot\alpha=-g\frac{\varepsilon\eta}{1+\bar w^T\Gamma\bar w+\eta^2}

    Time is in units of :math:`1/\omega_0`, displacement in um: the gain depends on units, and ``1`` in SI
    would move nothing. The auxiliary signal is taken from the voltage that was *applied*, which is the same as
    3.1.2.14 in normal running and stays exact in saturation or while another controller drives.
    """

    title = "Direct MRAC"
    place = 6
    equations = (
        Equation("law", r"u=\theta^Tw,\quad w=[r,w_1,w_2,y]^T", "3.1.2.5-8"),
        Equation(
            "augmented error",
            r"\varepsilon=e+\alpha\eta,\quad \eta=\theta^T\bar w-G_m[u_{applied}],\quad \bar w=G_m[w]",
            "3.1.2.13-14",
            printed=r"\eta=\phi^T\bar w-G_m[\phi^Tw]",
            why="the parameter error phi cannot be computed; theta may replace it, because theta* cancels. Using "
            "the voltage applied keeps the identity in saturation and in shadow",
        ),
        Equation(
            "adaptation",
            r"\dot\theta=-\mathrm{sgn}(k_p/k_m)\,g\,\Gamma\,\frac{\varepsilon\bar w}{1+\bar w^T\Gamma\bar w+\eta^2}",
            "3.1.2.15-16",
        ),
        Equation(
            "Lyapunov function",
            r"V=\tfrac{1}{2g}\left(|1/k^*|\,\phi^T\Gamma^{-1}\phi+(\alpha-1/k^*)^2\right)",
        ),
    )
    structure = (
        Stage("State filters", "applied measured", "w1 w2", ("law",)),
        Stage(
            "Copies of the model", "reference w1 w2 measured applied", "filtered filtered_voltage", ("augmented error",)
        ),
        Stage("Error", "measured model", "error"),
        Stage("Augmentation", "gain filtered filtered_voltage", "auxiliary_error", ("augmented error",)),
        Stage("Augmented error", "error alpha auxiliary_error", "augmented_error", ("augmented error",)),
        Stage("Adaptation", "augmented_error auxiliary_error filtered", "gain alpha", ("adaptation",)),
        Stage("Law", "gain reference w1 w2 measured", "voltage", ("law",)),
        Stage("Lyapunov function", "gain alpha", "lyapunov lyapunov_rate", ("Lyapunov function",)),
    )

    class Params(BlockParams):
        """Gains of the adaptation, in um, V and 1/w0."""

        adaptation_gain: float = parameter(1.0, "adaptation gain g", equation="3.1.2.15", gt=0, le=1e6)
        filter_pole: float = parameter(
            1.0, "pole of the state filters over w0", equation="3.1.2.6", gt=0.05, le=10, live=False
        )
        output_weight: float | None = parameter(
            None,
            "weight of w2 and y in Gamma; 1/kp^2 unless given, so that y counts in volts",
            "V^2/um^2",
            gt=0,
        )
        leakage: float = parameter(0.0, "leakage of the gains, per 1/w0", ge=0, le=1)
        gain_bound: float = parameter(0.0, "bound of the gains (projection), 0 for none", ge=0)
        normalise: bool = parameter(True, "divide by 1 + w'Gw + eta^2")
        augment: bool = parameter(
            True, "adapt on the augmented error; off adapts on the plain one", equation="3.1.2.14"
        )
        auxiliary: Literal["applied", "printed"] = parameter(
            "applied",
            "voltage the auxiliary error is taken from: the one applied, or as printed the one asked for, which is "
            "another at the limit and while another controller drives",
            equation="3.1.2.14",
        )
        adapt_alpha: bool = parameter(True, "adapt alpha as well")
        bias_v: float = parameter(0.0, "constant regressor against a constant load, 0 for none", "V", ge=0, le=100)

    class Packed(AdaptationPacked):
        """The weight of w2 and y, filters and their pole, choices, the constant regressor."""

        weight: float
        filter_pole: float
        lag: Lag
        copy: Tick
        normalise: float
        augment: float
        adapt_alpha: float
        asked_for: float
        bias_v: float

    class State(Record):
        """Gains and alpha, filters, the last regressor and the last voltage of this law, whether it has run.

        A copy of the model filters the regressor and the voltage applied.
        """

        theta: Vector = vector(N)
        alpha: float
        w1: float
        w2: float
        last: Vector = vector(N)
        filtered: Records[Motion] = several(N)
        filtered_voltage: Motion
        voltage: float
        started: float

    class Ports(ControllerPorts, TruthPorts):
        """Ports of a controller, the truth, and the adaptation."""

        drive_offset: float = reads("effects.drive_offset", "V", "stray voltage at the comb")
        gain: Vector = tap("mixed", "adapted gains on r, w1, w2, y and a constant", labels=LABELS)
        gain_ideal: Vector = tap("mixed", "gains that would match the model exactly", labels=LABELS)
        alpha: float = tap("1", "adapted gain of the auxiliary error")
        error: float = tap("um", "measured minus model displacement")
        auxiliary_error: float = tap("um", "auxiliary error eta")
        augmented_error: float = tap("um", "augmented error epsilon")
        lyapunov: float = tap("um^2", "Lyapunov function V")
        lyapunov_rate: float = tap("um^2", "its derivative by theory, per 1/w0")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants and models that are not of second order."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        fill_normalised(p, context)
        (_, _, gain), (_, _, model_gain) = coefficients(context)
        p.sign = math.copysign(1.0, gain * model_gain)
        p.weight = 1.0 / gain**2 if params.output_weight is None else params.output_weight
        p.lag = lag(params.filter_pole, p.h, context.analogue)
        p.copy = model_filter(context)
        p.asked_for = params.auxiliary == "printed"
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Gains that match the nominal device, everything else zero."""
        p, s = cls.pack(params, context), cls.State.zeros()
        s.theta[:CONSTANT] = matching(*coefficients(context)[0], p.model, params.filter_pole)
        s.alpha = 1.0 / s.theta[0]
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Measure, advance the filters, adapt, compute the voltage."""
        y = x.measured
        u, middle, end = moves(x)
        n = CONSTANT if p.bias_v == 0.0 else N
        if s.started != 0.0:
            for i in range(n):
                advance_motion(p.copy, s.filtered[i], s.last[i])  # w~ = G_m[w]
            if p.asked_for == 0.0:
                advance_motion(p.copy, s.filtered_voltage, u)  # G_m[u]
                add_moves(p.copy, s.filtered_voltage, middle, end)
            else:
                advance_motion(p.copy, s.filtered_voltage, s.voltage)
            s.w1 = advance_lag(p.lag, s.w1, u, middle, end)  # w1' = -lam w1 + u
            s.w2 = advance_lag(p.lag, s.w2, s.last[Y], 0.0, 0.0)  # w2' = -lam w2 + y
        s.started = 1.0
        s.last[0], s.last[1], s.last[2], s.last[3], s.last[4] = x.reference, s.w1, s.w2, y, p.bias_v

        e = flush_tiny(y - x.model)
        eta = -s.filtered_voltage.x
        den = 1.0
        for i in range(n):
            filtered = s.filtered[i].x
            eta += s.theta[i] * filtered
            den += weight_of(i, p.weight) * filtered * filtered
        eta = flush_tiny(eta)
        den += eta * eta
        if p.normalise == 0.0:
            den = 1.0
        eps = flush_tiny(e + s.alpha * eta) if p.augment != 0.0 else e
        rate = p.h * p.adaptation_gain / den
        voltage = 0.0
        for i in range(n):
            weight = weight_of(i, p.weight)
            theta = s.theta[i]
            theta += -p.sign * rate * weight * eps * s.filtered[i].x - leak(p, theta)
            theta = bounded(p, theta, weight)
            s.theta[i] = theta
            voltage += theta * s.last[i]
        if p.adapt_alpha != 0.0:
            s.alpha -= rate * eps * eta
        s.voltage = voltage
        x.voltage = voltage

        ideal = x.gain_ideal
        a1, a2, gain = true_plant(x, p.plant)
        ideal[0], ideal[1], ideal[2], ideal[3] = matching(a1, a2, gain, p.model, p.filter_pole)
        # this gain cancels a constant voltage at the comb
        offset = x.drive_offset / x.drive_gain
        ideal[CONSTANT] = -(1.0 - ideal[1] / p.filter_pole) * offset / p.bias_v if n == N else 0.0
        for i in range(N):
            x.gain[i] = s.theta[i]
        inverse = 1.0 / ideal[0]
        squares = abs(inverse) * distance(s.theta, ideal, n, p.weight) + (s.alpha - inverse) * (s.alpha - inverse)
        x.alpha = s.alpha
        x.error = e
        x.auxiliary_error = eta
        x.augmented_error = eps
        x.lyapunov = 0.5 * squares / p.adaptation_gain
        x.lyapunov_rate = -eps * eps / den
