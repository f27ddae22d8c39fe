"""Direct model reference adaptive control, relative degree one: with velocity, or for plants of first order."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.control.adaptation import REGRESSORS, AdaptationPacked, Y, bounded, distance, leak, weight_of
from core.control.controller import (
    Coefficients,
    ControllerPorts,
    Lag,
    TruthPorts,
    VelocityPorts,
    advance_lag,
    coefficients,
    fill_normalised,
    lag,
    matching,
    model_filter,
    true_plant,
    unsuited_order,
)
from core.control.velocity import PackedVelocity, Source, VelocityState, velocity, velocity_of, velocity_source
from core.kernel import flush_tiny, kernel
from core.ports import tap
from core.record import Record, Vector, vector
from core.voltage import Motion, Tick, add_moves, advance_motion, moves


@kernel
def matching_lead(
    a1: float, a2: float, gain: float, model: Coefficients, pole: float, lead: float, first_order: bool
) -> tuple[float, float, float, float]:
    r"""Return the gains on r, w1, w2 and :math:`y_c=y+\dot y/c` that make the loop equal the model.

    From :math:`(\Lambda-\theta_1)R_p-\tfrac{k_p}{c}(s+c)(\theta_2+\theta_0\Lambda)=\Lambda R_m,\;\Lambda=s+\lambda`:

    .. math:: \theta_1=\frac{(c-\lambda)[(a_{p1}-a_{m1})-(a_{p2}-a_{m2})/c]}{c-a_{p1}+a_{p2}/c}

    A plant of first order needs neither lead nor filters.
    """
    if first_order:
        return model.gain / gain, 0.0, 0.0, (a2 - model.a2) / gain
    if lead == 0.0:
        return matching(a1, a2, gain, model, pole)
    c = 1.0 / lead
    first = (c - pole) * ((a1 - model.a1) - (a2 - model.a2) * lead) / (c - a1 + a2 * lead)
    through = (a1 - model.a1 - first) / (gain * lead)
    rest = ((pole - first) * a2 - pole * model.a2) / gain
    return model.gain / gain, first, rest - pole * through, through


class MracVelocity(Block):
    r"""Direct MRAC of relative degree one (3.1.2.12): no augmented error, but it needs the velocity.

    .. math:: u=\theta^Tw,\quad w=[r,w_1,w_2,y_c],\;y_c=y+\dot y/c,\quad \dot\theta=-\mathrm{sgn}(k_p)\,g\,\Gamma e_cw

    With :math:`c<a_{m1}` the model from r to :math:`y_{c}` is strictly positive real, which the plain law needs; on y
    alone it is not. A plant of first order is so by itself. The error belongs to this law's own voltage: a copy of the
    model takes out the effect of another controller's voltage, so the law learns in shadow and in saturation.
    """

    title = "Direct MRAC with velocity"
    place = 7
    equations = (
        Equation("law", r"u=\theta^Tw,\quad w=[r,w_1,w_2,y_c]^T,\quad y_c=y+\dot y/c,\;c=0.9\,a_{m1}", "3.1.2.5-8"),
        Equation(
            "adaptation",
            r"\dot\theta=-\mathrm{sgn}(k_p)\,g\,\Gamma\,e_c\,w",
            "3.1.2.12",
            printed=r"\dot\theta=-\mathrm{sgn}(k_p)\,g\,e\,w",
            why="from r to y the resonator is of relative degree two and not positive real: the plain law on y fails "
            "at small gains already",
        ),
        Equation(
            "Lyapunov function, first order",
            r"V=\tfrac12e^2+\tfrac{|k_p|}{2g}\phi^T\Gamma^{-1}\phi,\quad\dot V=-a_me^2",
        ),
    )
    structure = (
        Stage("State filters", "applied measured", "w1 w2", ("law",)),
        Stage("Error", "measured velocity model model_velocity", "error"),
        Stage("Correction for the voltage", "error voltage applied", "own_error"),
        Stage("Adaptation", "own_error reference w1 w2 measured", "gain", ("adaptation",)),
        Stage("Law", "gain reference w1 w2 measured velocity", "voltage", ("law",)),
        Stage("Lyapunov function", "gain own_error", "lyapunov lyapunov_rate", ("Lyapunov function, first order",)),
    )

    class Params(BlockParams):
        """Parameters of the law, in um, V and 1/w0."""

        adaptation_gain: float = parameter(0.05, "adaptation gain g", equation="3.1.2.12", gt=0, le=1e6)
        form: Literal["relative_degree_one", "printed"] = parameter(
            "relative_degree_one",
            "on displacement and velocity, or as printed on displacement alone; the same for a plant of first order",
            equation="3.1.2.12",
            live=False,
        )
        zero: float = parameter(
            0.9, "zero c over the damping a1 of the model; below 1 is positive real", gt=0, le=10, live=False
        )
        filters: bool | None = parameter(
            None, "filters of input and output; unless given, for plants of second order only", live=False
        )
        filter_pole: float = parameter(1.0, "pole of the state filters over w0", gt=0.05, le=10, live=False)
        output_weight: float | None = parameter(
            None, "weight of w2 and y in Gamma; 1/kp^2 unless given, so that y counts in volts", "V^2/um^2", gt=0
        )
        start: Literal["nominal", "zero"] = parameter(
            "nominal", "gains at the start: matched to the nominal device, or zero", live=False
        )
        leakage: float = parameter(0.0, "leakage of the gains, per 1/w0", ge=0, le=1)
        gain_bound: float = parameter(30.0, "bound of the gains (projection), 0 for none", ge=0)
        velocity: Source = velocity_source()

    class Packed(AdaptationPacked):
        """Weight of w2 and y, effect of a volt on the error, filters, share of the velocity, order of the plant."""

        weight: float
        reach: float
        filtering: float
        filter_pole: float
        lead: float
        ratio: float
        first_order: float
        lag: Lag
        copy: Tick
        velocity: PackedVelocity

    class State(Record):
        """Gains, filters, last regressor, last voltage of this law, effect of its excess voltage, the velocity."""

        theta: Vector = vector(4)
        w1: float
        w2: float
        last: Vector = vector(4)
        voltage: float
        missed: Motion
        velocity: VelocityState

    class Ports(ControllerPorts, VelocityPorts, TruthPorts):
        """Ports of a controller, velocities, the truth, and the adaptation."""

        gain: Vector = tap("mixed", "adapted gains on r, w1, w2 and y", labels=REGRESSORS)
        gain_ideal: Vector = tap("mixed", "gains that would match the model exactly", labels=REGRESSORS)
        error: float = tap("um", "measured minus model output, velocity included")
        own_error: float = tap("um", "the same, had its own voltage been applied")
        lyapunov: float = tap("um^2", "Lyapunov function V of a plant of first order")
        lyapunov_rate: float = tap("um^2", "its derivative by theory, first order only, per 1/w0")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse a model of another kind than the plant."""
        return unsuited_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        plant, model, lead = cls.shape(params, context)
        p = cls.Packed.blank()
        fill_normalised(p, context)
        p.sign = math.copysign(1.0, plant[2])
        p.weight = 1.0 / plant[2] ** 2 if params.output_weight is None else params.output_weight
        p.lead, p.ratio, p.first_order = lead, plant[2] / model[2], context.device.mass == 0.0
        p.filtering = not p.first_order if params.filters is None else params.filters
        p.lag = lag(params.filter_pole, p.h, context.analogue)
        p.copy = model_filter(context)
        p.reach = abs(p.ratio * (p.copy.push1 + lead * p.copy.push2))
        p.velocity = velocity_of(params.velocity, context)
        return p

    @classmethod
    def shape(
        cls, params: Any, context: Context
    ) -> tuple[tuple[float, float, float], tuple[float, float, float], float]:
        """Return coefficients of plant and model, and the weight of the velocity in 1/w0."""
        plant, model = coefficients(context)
        needs_lead = context.device.mass > 0.0 and params.form != "printed"
        return plant, model, 1.0 / (params.zero * (model[0] or 1.0)) if needs_lead else 0.0

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Gains that match the nominal device, everything else zero."""
        p, s = cls.pack(params, context), cls.State.zeros()
        if params.start == "nominal":
            plant, first_order = coefficients(context)[0], context.device.mass == 0.0
            s.theta[:] = matching_lead(*plant, p.model, params.filter_pole, p.lead, first_order)
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Measure, advance the filters, adapt, compute the voltage."""
        u, middle, end = moves(x)
        y = x.measured
        y += p.lead * velocity(p.velocity, s.velocity, x.velocity, y, u, middle, end) / p.velocity.rate
        # the motion of the plant, had the voltage of this law been applied
        advance_motion(p.copy, s.missed, s.voltage - u)
        add_moves(p.copy, s.missed, -middle, -end)
        if p.filtering != 0.0:
            s.w1 = advance_lag(p.lag, s.w1, u, middle, end)
            s.w2 = advance_lag(p.lag, s.w2, s.last[Y], 0.0, 0.0)
        e = y - (x.model + p.lead * x.model_velocity / p.velocity.rate)
        own_error = flush_tiny(e + p.ratio * (s.missed.x + p.lead * s.missed.v))

        first_order = p.first_order != 0.0
        a1, a2, gain = true_plant(x, p.plant)
        if first_order:  # without mass, faults of damping act on these coefficients
            a1, a2, gain = 0.0, a2 * x.mass_scale, gain * x.mass_scale
            a2 /= x.damping_scale
            gain /= x.damping_scale
        ideal = x.gain_ideal
        ideal[0], ideal[1], ideal[2], ideal[3] = matching_lead(
            a1, a2, gain, p.model, p.filter_pole, p.lead, first_order
        )
        # The step of an implicit method: a sample changes the error by ``reach`` times the change of the voltage. The
        # law adapts along the last regressor, which appears in the error. Along the present one, a voltage that turns
        # at every sample, as in chatter, would turn the sign of the law.
        size = s.last[0] * s.last[0] + s.last[1] * s.last[1]
        size += p.weight * (s.last[2] * s.last[2] + s.last[3] * s.last[3])
        rate = p.h * p.adaptation_gain * own_error / (1.0 + p.h * p.adaptation_gain * p.reach * size)
        for i in range(4):
            weight = weight_of(i, p.weight)
            theta = s.theta[i]
            theta += -p.sign * rate * weight * s.last[i] - leak(p, theta)
            theta = bounded(p, theta, weight)
            s.theta[i] = theta
            x.gain[i] = theta
        s.last[0], s.last[1], s.last[2], s.last[3] = x.reference, s.w1, s.w2, y
        voltage = 0.0
        for i in range(4):
            voltage += s.theta[i] * s.last[i]
        s.voltage = voltage
        x.voltage = voltage
        missing = distance(s.theta, ideal, 4, p.weight)
        x.error = e
        x.own_error = own_error
        x.lyapunov = 0.5 * own_error * own_error + 0.5 * abs(gain) * missing / p.adaptation_gain
        x.lyapunov_rate = -p.model.a2 * own_error * own_error if first_order else 0.0
