"""Self-tuning variable structure control: a gradient estimator tunes the gains of a sliding law."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Block, Context, Equation, Oscillator, Stage, parameter
from core.control.controller import TruthPorts, coefficients, true_plant, unsuited_second_order
from core.control.sliding import (
    BOUNDARY_LAYER,
    GAINS_EQUATION,
    LAYER_EQUATION,
    SURFACE,
    SURFACE_EQUATION,
    SlidingPacked,
    SlidingParams,
    SwitchingPorts,
    SwitchingState,
    fill_sliding,
    slide,
)
from core.control.velocity import velocity
from core.estimation import DrivenFilter, driven_filter_of, filter_input, filter_voltage
from core.kernel import flush_tiny
from core.ports import tap
from core.record import Vector, vector
from core.voltage import Motion, moves

LABELS = ("gain", "a2", "a1")
HUGE = 1e9
"""Bound of an estimate that runs away without its normaliser, so that it stays a finite number."""


class Stvsc(Block):
    r"""Self-tuning variable structure control, :math:`u=u_{eq}+\rho M\,\mathrm{sat}(s/\Phi)`.

    A normalised gradient estimator follows mass, damping and spring; the sliding law is computed from its estimate.
    It estimates all the time from the voltage applied, so it is tuned when the loop switches to it.
    """

    title = "Self-tuning VSC"
    place = 10
    equations = (
        Equation(
            "law",
            r"u=u_{eq}+\rho M\,\mathrm{sat}(s/\Phi),\quad u_{eq}=K_e^Te+K_p^Tx_p+K_mr,\quad M=\sum|\cdot|",
            "3.2.4.2.1",
            printed=r"U_P=|K_py_P|+K_e|y_M-y_P|+|K_MU_M|\,\mathrm{sgn}(s)",
            why="products are taken component by component with absolute values, and the equivalent control is added: "
            "switching alone must be as large as the whole voltage",
        ),
        Equation(
            "surface",
            SURFACE_EQUATION.latex,
            SURFACE_EQUATION.source,
            printed=r"s=Ge_1",
            why="e_1 is the error of the estimate: without motion it is always zero, and so is the voltage. "
            "The surface needs the tracking error",
        ),
        GAINS_EQUATION,
        Equation(
            "estimator",
            r"\dot{\hat\theta}=-g\Gamma\frac{w\,e_1}{1+w^T\Gamma w},\quad e_1=\hat y-y,\quad "
            r"\dot V=-\frac{2e_1^2}{1+w^T\Gamma w}\le0",
            "3.2.3.8, 3.2.5.1.4",
            printed=r"\hat\theta=-P_0we_1",
            why="the dot is lost, and without the normaliser the law runs away for 0.3 and more; V falls only as far "
            "as the input excites",
        ),
        LAYER_EQUATION,
    )
    structure = (
        Stage("Filters of the estimator", "applied measured", "input output", ("estimator",)),
        Stage(
            "Estimator", "input output measured", "parameter prediction_error lyapunov lyapunov_rate", ("estimator",)
        ),
        SURFACE,
        Stage("Equivalent control", "parameter error measured velocity reference", "equivalent switching", ("gains",)),
        BOUNDARY_LAYER,
        Stage("Law", "equivalent switching surface", "voltage", ("law",)),
    )

    class Params(SlidingParams):
        """Sliding law and estimator, in um, V and 1/w0."""

        estimator_gain: float = parameter(1.0, "gain g of the estimator", equation="3.2.5.1.4", gt=0, le=10)
        filter_pole: float = parameter(
            1.0, "double pole of the filters over w0", equation="3.2.3.3", gt=0.05, le=10, live=False
        )
        output_weight: float | None = parameter(
            None, "weight of y and its derivative; 1/kp^2 unless given, so that y counts in volts", "V^2/um^2", gt=0
        )
        normalise: bool = parameter(True, "divide by 1 + w'Gw; off as printed", equation="3.2.5.1.4")
        gain_floor: float = parameter(0.1, "least share of the nominal gain the estimate may fall to", gt=0, le=1)
        surface: Literal["tracking", "estimation"] = parameter(
            "tracking",
            "error the surface is made of; the printed one is the error of the estimate",
            equation="3.2.4.1.1",
        )

    class Packed(SlidingPacked):
        """The sliding law, filters and their pole, estimator, whether the surface uses the error of the estimate."""

        filter: DrivenFilter
        filter_pole: float
        estimator_gain: float
        weight: float
        gain_floor: float
        normalise: float
        on_estimate: float

    class State(SwitchingState):
        """State of the sliding law, estimate of kp, a2 and a1, filters, the last measurement."""

        theta: Vector = vector(3)
        input: Motion
        output: Motion
        last: float

    class Ports(SwitchingPorts, TruthPorts):
        """Ports of the sliding law, the truth, and the estimate."""

        parameter: Vector = tap("mixed", "estimates of kp, a2 and a1, time in 1/w0", labels=LABELS)
        parameter_true: Vector = tap("mixed", "what they should be", labels=LABELS)
        prediction_error: float = tap("um", "estimated minus measured displacement")
        lyapunov: float = tap("1", "Lyapunov function V of the estimator")
        lyapunov_rate: float = tap("1", "its derivative by theory, per 1/w0")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants and models that are not of second order."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        fill_sliding(p, params, context)
        gain = coefficients(context)[0][2]
        p.filter = driven_filter_of(params.filter_pole, p.h, context.analogue)
        p.weight = 1.0 / gain**2 if params.output_weight is None else params.output_weight
        p.on_estimate = params.surface == "estimation"
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Estimates of the nominal device, everything else zero."""
        a1, a2, gain = coefficients(context)[0]
        s = cls.State.zeros()
        s.theta[:] = gain, a2, a1
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Estimate from the voltage applied, then slide with the estimate."""
        y = x.measured
        u, middle, end = moves(x)
        filter_voltage(p.filter, s.input, u, middle, end)
        filter_input(p.filter, s.output, s.last, y)
        s.last = y
        pole = p.filter_pole
        gain, spring, damping = s.theta[0], s.theta[1], s.theta[2]
        # y = kp u* + (lam^2 - a2) y* + (2 lam - a1) py*, with * for 1/(s + lam)^2
        u_filtered, y_filtered, rate_filtered = s.input.x, s.output.x, s.output.v
        error = flush_tiny(
            gain * u_filtered + (pole * pole - spring) * y_filtered + (2.0 * pole - damping) * rate_filtered - y
        )
        weight = p.weight
        den = 1.0
        if p.normalise != 0.0:
            den += u_filtered * u_filtered + weight * (y_filtered * y_filtered + rate_filtered * rate_filtered)
        gradient = p.estimator_gain * error / den
        gain -= p.h * gradient * u_filtered
        floor = p.gain_floor * abs(p.plant.gain)
        gain = p.sign * min(max(p.sign * gain, floor), HUGE)
        spring = min(max(spring + p.h * gradient * weight * y_filtered, -HUGE), HUGE)
        damping = min(max(damping + p.h * gradient * weight * rate_filtered, -HUGE), HUGE)
        s.theta[0], s.theta[1], s.theta[2] = gain, spring, damping

        v = velocity(p.velocity, s.velocity, x.velocity, y, u, middle, end) / p.velocity.rate
        x.voltage = slide(p, s, x, y, v, damping, spring, gain, error, p.on_estimate != 0.0)

        a1, a2, true_gain = true_plant(x, p.plant)
        x.parameter[0], x.parameter[1], x.parameter[2] = gain, spring, damping
        x.parameter_true[0], x.parameter_true[1], x.parameter_true[2] = true_gain, a2, a1
        missing = gain - true_gain
        lyapunov = missing * missing
        missing = spring - a2
        lyapunov += missing * missing / weight
        missing = damping - a1
        lyapunov += missing * missing / weight
        x.prediction_error = error
        x.lyapunov = lyapunov / p.estimator_gain
        x.lyapunov_rate = -2.0 * error * error / den
