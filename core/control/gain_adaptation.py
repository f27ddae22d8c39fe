"""The early rules that adapt one gain: MIT, Lyapunov, Dressler, Price, Monopoli."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.control.controller import ControllerPorts
from core.elementary import exp
from core.kernel import flush_tiny
from core.ports import reads, tap
from core.record import Record
from core.theory.gain_adaptation import LYAPUNOV, MIT, MONOPOLI, PARKS, PRICE, RULES


class GainAdaptation(Block):
    r"""One gain in front of a plant of unknown gain, :math:`u=k_cr`, by the rules of appendix B.

    .. math:: \text{MIT: }\dot k_c=Bey_m;\quad\text{Lyapunov: }\dot k_c=B(\dot e+ce)r;\quad\text{Dressler: }\dot k_c=Ber

    .. math:: \text{Price: }k_c=\int Ber\,dt+\gamma Ber;\quad
        \text{Monopoli: }k_c=\int Bey\,dt+\gamma Bey,\;y=\frac{r}{1+qs},\;u=k_cr+q\dot k_cy

    with :math:`e=y_m-y_p`. For a plant :math:`k_v/(b_2s^2+b_1s+1)` and a constant reference R the MIT rule and
    Dressler's are stable up to :math:`b_1/(b_2kk_vR^2)` and :math:`b_1/(b_2k_vR^2)`; Price's always for
    :math:`\gamma\ge b_2/b_1`, Monopoli's for :math:`q>b_2/b_1`, Lyapunov's for :math:`0<c<b_1/b_2`. Under a sine the
    first two have tongues of instability.
    """

    title = "Gain adaptation (appendix B)"
    place = 13
    equations = (
        Equation(
            "MIT rule",
            r"\dot k_c=-Be\frac{\partial e}{\partial k_c}\propto ey_m",
            "B.1.1",
            printed=r"k_c=-Be\frac{\partial e}{\partial k_c}",
            why="the dot is missing: a gain in proportion to the error leaves an error",
        ),
        Equation(
            "Lyapunov rule",
            r"\dot k_c=B(\dot e+ce)r,\quad0<c<b_1/b_2",
            "B.2.5-8",
            printed=r"\dot x=-k_v\dot k_c=\frac{-b_1er}{\lambda b_2}",
            why="B.2.5 has e^2 for e'^2, B.2.8 lacks a square and a b2, and they give e' for e; that rule alone "
            "stops at e = kR/(1 + kv B R^2), so a part c e is added",
        ),
        Equation("Dressler's rule", r"\dot k_c=Ber", "B.3.1"),
        Equation("Price's rule", r"\dot k_c=Ber+\gamma\frac{d}{dt}(Ber)", "B.4.1"),
        Equation(
            "Monopoli's rule",
            r"\dot k_c=Bey+\gamma\frac{d}{dt}(Bey),\quad y=\frac{r}{1+qs},\quad u=k_cr+q\dot k_cy",
            "B.5.1",
        ),
    )
    structure = (
        Stage("Error", "model measured", "error"),
        Stage("Monopoli's filter", "reference", "filtered"),
        Stage(
            "Adaptation",
            "error reference model filtered",
            "gain",
            ("MIT rule", "Lyapunov rule", "Dressler's rule", "Price's rule"),
        ),
        Stage("Law", "gain reference filtered", "voltage", ("Monopoli's rule",)),
    )

    class Params(BlockParams):
        """Rule and gains, in um, V and the plant's unit of time."""

        rule: Literal["mit", "lyapunov", "dressler", "price", "monopoli"] = parameter("lyapunov", "which rule")
        form: Literal["corrected", "derived", "printed"] = parameter(
            "corrected",
            "corrected; as derived (Lyapunov: on the slope of the error alone); or as printed (MIT: without its dot, "
            "Lyapunov: on the error alone)",
        )
        adaptation_gain: float = parameter(0.4, "adaptation gain B", equation="B.1.1", gt=0, le=1e4)
        error_weight: float = parameter(0.5, "part c of the error in Lyapunov's rule", equation="B.2.8", ge=0, le=1e3)
        proportional: float = parameter(1.0, "gamma of Price's and Monopoli's rules", equation="B.4.1", ge=0, le=1e3)
        filter_time: float = parameter(1.5, "time constant q of Monopoli's filter", equation="B.5.1", gt=0.001, le=1e3)
        initial_gain: float = parameter(0.0, "gain at the start", ge=-1e3, le=1e3, live=False)

    class Packed(Record):
        """The rule, sample interval in 1/w0, gains, Monopoli's filter, and the gain that matches the nominal plant."""

        rule: float
        h: float
        adaptation_gain: float
        error_weight: float
        proportional: float
        filter_time: float
        decay: float
        ideal: float
        algebraic: float

    class State(Record):
        """Integral, error and reference of the last sample, Monopoli's filter and its product, whether it has run."""

        integral: float
        last_error: float
        last_reference: float
        filtered: float
        last_product: float
        started: float

    class Ports(ControllerPorts):
        """Ports of a controller, the truth about the gain, and the adaptation."""

        stiffness_scale: float = reads(
            "effects.stiffness_scale", "1", "true stiffness over nominal, for the ideal gain"
        )
        drive_gain: float = reads("effects.drive_gain", "1", "voltage at the plant over voltage applied")
        gain: float = tap("1", "adapted gain kc")
        gain_ideal: float = tap("1", "gain that would match the model")
        error: float = tap("um", "model minus measured displacement")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without a static gain to match, and resonators, whose gain is known."""
        if device.time_unit_ms == 0.0:
            return "is for the plants of appendix B; choose first-order-gain or second-order-gain"
        whole = min(device.stiffness, model.stiffness) > 0.0 and device.force != 0.0
        return "" if whole else "needs a plant and a model that come to rest"

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        rule = params.rule
        if rule == "lyapunov" and params.form != "corrected":
            rule = {"derived": "parks", "printed": "dressler"}[params.form]
        p = cls.Packed.blank()
        p.rule = RULES[rule]
        p.h = context.dt_ms * context.device.natural_frequency
        p.decay = exp(-p.h / params.filter_time)
        p.ideal = context.model.static_gain / context.device.static_gain
        p.algebraic = params.rule == "mit" and params.form == "printed"
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Start with the given gain, before the first sample."""
        s = cls.State.zeros()
        s.integral = params.initial_gain
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Compare, adapt the gain, scale the reference."""
        r, ym = x.reference, x.model
        e = flush_tiny(ym - x.measured)
        if s.started == 0.0:
            s.started = 1.0
            s.last_error = e
        else:
            # y' = (r - y)/q with the reference held
            s.filtered = flush_tiny(p.decay * s.filtered + (1.0 - p.decay) * s.last_reference)
        rule = p.rule
        slope = p.adaptation_gain * e * r
        if rule == MIT:
            slope = p.adaptation_gain * e * ym
        elif rule == MONOPOLI:
            slope = p.adaptation_gain * e * s.filtered
        elif rule == PARKS or rule == LYAPUNOV:
            # the integral of e' r over a sample with r held needs no derivative
            s.integral += p.adaptation_gain * (e - s.last_error) * s.last_reference
            slope = p.adaptation_gain * p.error_weight * e * r if rule == LYAPUNOV else 0.0
        s.integral += p.h * slope
        gain = s.integral
        if rule == PRICE or rule == MONOPOLI:
            gain += p.proportional * slope
        if p.algebraic != 0.0:
            gain = slope
        u = gain * r
        if rule == MONOPOLI:
            # the slope of the gain: e y over the sample before
            product = e * s.filtered
            growth = slope + p.adaptation_gain * p.proportional * (product - s.last_product) / p.h
            u += p.filter_time * growth * s.filtered
            s.last_product = product
        s.last_error, s.last_reference = e, r
        x.voltage = u
        x.gain = gain
        x.gain_ideal = p.ideal * x.stiffness_scale / x.drive_gain
        x.error = e
