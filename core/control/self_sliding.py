"""Self-sliding adaptive control: three static gains, adapted by the sign of the error."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.control.adaptation import AdaptationPacked, bounded, distance, leak
from core.control.controller import (
    ControllerPorts,
    TruthPorts,
    VelocityPorts,
    coefficients,
    fill_normalised,
    model_filter,
    saturated,
    true_plant,
    unsuited_order,
)
from core.control.velocity import PackedVelocity, Source, VelocityState, velocity, velocity_of, velocity_source
from core.kernel import flush_tiny
from core.ports import tap
from core.record import Record, Records, Vector, several, vector
from core.voltage import Motion, Tick, add_moves, advance_motion, moves

LABELS = ("r", "y", "e", "rate")


class SelfSliding(Block):
    r"""Self-sliding adaptive control of chapter 4: static gains on r, y and e, adapted by the sign of the error.

    .. math:: u=k_rr+k_yy+k_ee,\quad \dot\theta=-\mathrm{sgn}(k_p)\,P_0\,\mathrm{sgn}(s)\,w,\quad e=y-y_m

    ``relative_degree_one`` has :math:`s=e`; ``augmented`` has :math:`s=e+\alpha(\theta^T\bar w-G_m[u])` and adapts
    along the filtered regressor :math:`\bar w=G_m[w]`; ``printed`` along w itself; ``velocity`` has
    :math:`s=\dot e+ce` and feeds back s and the velocity as well. Static gains cannot add damping, so the
    error of a damping fault or of a large mass fault remains; no value of :math:`k_e` is ideal.
    """

    title = "Self-sliding control"
    place = 12
    equations = (
        Equation(
            "law",
            r"u=k_rr+k_yy+k_ee,\quad e=y-y_m",
            "4.2.1.1-3",
            printed=r"C=k_pR_p+k_e(R_m-R_p)+k_rr",
            why="with e = R_m - R_p the printed minus signs of the adaptation are positive feedback",
        ),
        Equation("adaptation", r"\dot\theta=-\mathrm{sgn}(k_p)\,P_0\,\mathrm{sgn}(s)\,w", "4.2.1.4-6"),
        Equation(
            "augmented error",
            r"\varepsilon=e+\alpha\eta,\;\eta=\theta^T\bar w-G_m[u],\;\bar w=G_m[w]",
            "4.2.2.1-5",
            printed=r"\eta=\theta^T[G_m\omega]-[G_m\theta^T]\omega",
            why="the model acts on the product; and along the raw regressor k_e runs away under noise",
        ),
        Equation(
            "Lyapunov function, first order",
            r"V=|e|+\tfrac{|k_p|}{2P_0}\phi^T\phi,\quad \dot V=-a_m|e|",
            "4.2.1.7-13",
            printed=r"V=\tfrac12e^2+\tfrac{|s|}{2P_0}(\tilde k_e^2+\tilde k_r^2+\tilde k_p^2)",
            why="the printed V is 0 whenever e is, whatever the gains, and its proof drops the term of the model",
        ),
    )
    structure = (
        Stage("Error", "measured model", "error"),
        Stage("Augmentation", "gain reference measured error applied", "auxiliary_error", ("augmented error",)),
        Stage("Surface", "error auxiliary_error velocity model_velocity", "surface alpha", ("augmented error",)),
        Stage("Adaptation", "surface reference measured error", "gain", ("adaptation",)),
        Stage("Law", "gain reference measured error", "voltage", ("law",)),
        Stage("Lyapunov function", "gain surface", "lyapunov lyapunov_rate", ("Lyapunov function, first order",)),
    )

    class Params(BlockParams):
        """Parameters of the law, in um, V and 1/w0."""

        adaptation_gain: float = parameter(0.03, "adaptation gain P0", equation="4.2.1.4-6", gt=0, le=1e4)
        form: Literal["augmented", "relative_degree_one", "velocity", "printed"] = parameter(
            "augmented",
            "augmented error with filtered regressor, plain error, surface with velocity, or augmented error with the "
            "raw regressor as printed",
            equation="4.2.2",
        )
        signs: Literal["working", "printed"] = parameter(
            "working", "error measured minus model, or as printed", equation="4.2.1.1"
        )
        alpha_gain: float = parameter(
            0.3, "gain of the weight of the auxiliary error", equation="4.2.2.5", ge=0, le=1e3
        )
        surface_slope: float = parameter(2.0, "c of the surface with velocity, over w0", gt=0, le=100)
        layer_um: float = parameter(0.0, "boundary layer of the sign, 0 for none", "um", ge=0, le=100)
        start: Literal["nominal", "zero"] = parameter(
            "nominal", "gains at the start: matched to the nominal device, or zero", live=False
        )
        leakage: float = parameter(0.0, "leakage of the gains, per 1/w0", ge=0, le=1)
        gain_bound: float = parameter(0.0, "bound of the gains, 0 for none", ge=0)
        velocity: Source = velocity_source()

    class Packed(AdaptationPacked):
        """Gain of alpha, boundary layer, the form (error, regressor, surface), its sign, ratio of gains, order."""

        alpha_gain: float
        layer_um: float
        augmented: float
        filtered_regressor: float
        with_velocity: float
        orientation: float
        surface_slope: float
        ratio: float
        second_order: float
        copy: Tick
        velocity: PackedVelocity

    class State(Record):
        """Gains and alpha, the last regressor and the filtered one, the last voltage of this law, the velocity source.

        With an augmented error the filtered voltage is the applied voltage; without it, the law's own voltage less the
        applied voltage.
        """

        theta: Vector = vector(4)
        alpha: float
        last: Vector = vector(4)
        filtered: Records[Motion] = several(3)
        filtered_voltage: Motion
        voltage: float
        velocity: VelocityState

    class Ports(ControllerPorts, VelocityPorts, TruthPorts):
        """Ports of a controller, velocities, the truth, and the adaptation."""

        gain: Vector = tap("mixed", "adapted gains on r, y, e (or s) and the velocity", labels=LABELS)
        gain_ideal: Vector = tap("mixed", "gains that would match, as far as static ones can", labels=LABELS)
        error: float = tap("um", "measured minus model displacement, or the other way round with the printed signs")
        surface: float = tap("um", "s, whose sign drives the adaptation")
        auxiliary_error: float = tap("um", "auxiliary error eta")
        alpha: float = tap("1", "adapted gain of the auxiliary error")
        lyapunov: float = tap("um", "Lyapunov function V of a plant of first order")
        lyapunov_rate: float = tap("um", "its derivative by theory, per 1/w0")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse a model of another kind than the plant."""
        return unsuited_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        fill_normalised(p, context)
        plant, model = coefficients(context)
        # the filtered regressor includes the sign of the model's gain
        p.sign = math.copysign(1.0, plant[2] * (model[2] if params.form == "augmented" else 1.0))
        p.augmented = params.form in ("augmented", "printed")
        p.filtered_regressor = params.form == "augmented"
        p.with_velocity = params.form == "velocity"
        p.orientation = 1.0 if params.signs == "working" else -1.0
        p.ratio = plant[2] / model[2]
        p.second_order = context.device.mass > 0.0
        p.copy = model_filter(context)
        p.velocity = velocity_of(params.velocity, context)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Gains at the start, everything else zero."""
        plant, model = coefficients(context)
        s = cls.State.zeros()
        s.alpha = plant[2] / model[2]
        if params.start == "nominal":
            s.theta[:2] = model[2] / plant[2], (plant[1] - model[1]) / plant[2]
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Measure, find the side of the surface, adapt, compute the voltage."""
        u, middle, end = moves(x)
        y = x.measured
        v = velocity(p.velocity, s.velocity, x.velocity, y, u, middle, end) / p.velocity.rate
        e = p.orientation * (y - x.model)
        eta = 0.0
        if p.augmented != 0.0:
            for i in range(3):
                advance_motion(p.copy, s.filtered[i], s.last[i])
            advance_motion(p.copy, s.filtered_voltage, u)
            add_moves(p.copy, s.filtered_voltage, middle, end)
            eta = -s.filtered_voltage.x
            size = 1.0
            for i in range(3):
                eta += s.theta[i] * s.filtered[i].x
                size += s.last[i] * s.last[i]
            eta = flush_tiny(p.orientation * eta)
            surface = flush_tiny(e + s.alpha * eta)
            s.alpha -= p.h * p.alpha_gain * surface * eta / size
        else:
            # The error belongs to this law's own voltage; while the law drives, there is no difference to take out.
            advance_motion(p.copy, s.filtered_voltage, s.voltage - u)
            add_moves(p.copy, s.filtered_voltage, -middle, -end)
            missing = p.orientation * p.ratio
            surface = flush_tiny(e + missing * s.filtered_voltage.x)
            if p.with_velocity != 0.0:
                slope = p.orientation * (v - x.model_velocity / p.velocity.rate) + missing * s.filtered_voltage.v
                surface = flush_tiny(p.surface_slope * surface + slope)
        s.last[0], s.last[1], s.last[2], s.last[3] = x.reference, y, e, 0.0
        if p.with_velocity != 0.0:
            s.last[2], s.last[3] = surface, v

        a1, a2, gain = true_plant(x, p.plant)
        if p.second_order == 0.0:  # without mass, faults of damping act on these coefficients
            scale = x.mass_scale / x.damping_scale
            a1, a2, gain = 0.0, a2 * scale, gain * scale
        ideal = x.gain_ideal
        inverse = 1.0 / gain
        ideal[0], ideal[1], ideal[2] = p.model.gain * inverse, (a2 - p.model.a2) * inverse, 0.0
        ideal[3] = (a1 - p.model.a1) * inverse if p.with_velocity != 0.0 else 0.0
        rate = p.h * p.adaptation_gain * p.sign * saturated(surface, p.layer_um)
        voltage = 0.0
        for i in range(4):
            regressor = s.filtered[i].x if p.filtered_regressor != 0.0 and i < 3 else s.last[i]
            theta = s.theta[i]
            theta -= rate * regressor + leak(p, theta)
            theta = bounded(p, theta, 1.0)
            s.theta[i] = theta
            voltage += theta * s.last[i]
            x.gain[i] = theta
        s.voltage = voltage
        x.voltage = voltage
        missing = distance(s.theta, ideal, 4, 1.0)
        x.error = e
        x.surface = surface
        x.auxiliary_error = eta
        x.alpha = s.alpha
        x.lyapunov = abs(surface) + 0.5 * abs(gain) * missing / p.adaptation_gain
        x.lyapunov_rate = -p.model.a2 * abs(surface)
