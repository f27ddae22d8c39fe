"""Plant whose sideways motion is tied to its travel: a calibration to the text, not physics."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, parameter
from core.kernel import flush_tiny, kernel
from core.plant.contact import ContactParams, TouchingShuttle, resolved_us, stop, touch
from core.plant.shuttle import (
    LEFT,
    RIGHT,
    Shuttle,
    at_rest_sideways,
    comb_voltage,
    comb_voltage_parabola,
    drive_noise,
    dry_friction,
    joined,
    thermal_force,
)
from core.record import Record


class SlavedLateral(TouchingShuttle):
    r"""Sideways motion tied to the travel, :math:`\eta=\kappa x`: a calibration to the text's 1.67 um, not physics.

    .. math:: m\ddot x=-k_1x-\beta\dot x+\tfrac12n\varepsilon_0t\left\{V_1^2[G+\kappa G'(L+x)]
        +V_2^2[-G+\kappa G'(L-x)]\right\}

    The text turns the shuttle about the point of adhesion as about a rigid pivot, and it loses stability at a third of
    the gap. Elasticity gives a hundredth of that rotation (see the planar plant); with the overlap shortened to 5 um
    this plant folds at the place given by the text, so that the text's controllers can be tried on it. With the whole
    overlap of 40 um the same kinematics would be unstable without a drive beyond 4.1 V of bias.
    """

    title = "Slaved lateral plant (calibration)"
    equations = (
        Equation(
            "motion",
            r"m\ddot x=-k_1x-\beta\dot x+\tfrac12n\varepsilon_0t\{V_1^2[G+\kappa G'(L+x)]+V_2^2[-G+\kappa G'(L-x)]\}",
            "3.2.2, 3.2.6",
        ),
        Equation(
            "lateral motion",
            r"\eta=\kappa x,\quad\kappa=\tfrac{0.7}{1.667}=0.42",
            "3.2.6",
            printed=r"E=\tfrac{r_2}{r_1}=\tfrac{700}{350}=2,\quad 1.67\,\mu m",
            why="3.5 um / 2 is 1.75 um; 1.67 um is 3.5 um / 2.1, the ratio of the caption of figure 3.2.6.1.6",
        ),
    )

    class Params(ContactParams):
        """The calibration; comb and bias come from the device (the text's line needs LCR-350 with 5 V of bias)."""

        stiffness_n_m: float = parameter(
            0.0784, "stiffness along x with the adhesion, instead of the device's", "N/m", gt=0, le=100
        )
        ratio: float = parameter(0.42, "lateral displacement over travel", "1", ge=0, le=1)
        effective_overlap_um: float = parameter(5.0, "overlap that pulls sideways", "um", ge=0, le=200)
        step_us: float = parameter(0.25, "longest substep", "us", gt=0.01, le=0.5)

    class Packed(TouchingShuttle.Packed):
        """Spring, lateral displacement over travel, overlap, substeps of a sample."""

        stiffness_n_m: float
        ratio: float
        effective_overlap_um: float
        substeps: float

    class State(Record):
        """Time of the first contact."""

        touched_ms: float

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        mass = context.device.mass
        step = params.stop_step_us(params.step_us, mass)
        if params.ratio > 0.0:
            # the lever of their sideways motion scales the forces of the fingers on the shuttle
            felt = mass / (params.ratio * params.ratio)
            step = resolved_us(step, params.contact_stiffness_n_m, params.contact_damping_ns_m * 1e3, felt)
        p: SlavedLateral.Packed = super().pack(params, context)
        p.substeps = float(math.ceil(context.dt_ms * 1e3 / step - 1e-9))
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Time of the first contact."""
        s = cls.State.zeros()
        s.touched_ms = -1.0
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Shuttle.Ports) -> None:
        """Advance over the interval that ends now by Runge-Kutta substeps."""
        short = joined(x.short, x.shorted)
        at_rest_sideways(x, short)
        q = x.displacement
        v = x.velocity
        n = int(p.substeps)
        if x.tick == 0.0:
            q, v, n = p.initial_displacement_um, p.initial_velocity_um_ms, 0
        m = p.mass * x.mass_scale
        b = p.damping * x.damping_scale
        k = p.stiffness_n_m * x.stiffness_scale
        u0, rise, bend = comb_voltage_parabola(x)
        outside = -m * x.acceleration
        if n > 0:
            u0 += drive_noise(p, x.tick - 1.0)
            outside += thermal_force(p, b, x.tick - 1.0)
        rubbing = x.friction
        for i in range(n):
            h = p.dt_ms / n
            # the voltage in the middle of the substep, since it changes little over a quarter of a microsecond
            a = (i + 0.5) / n
            u = u0 + a * (rise + a * bend)
            right = comb_voltage(p.first_v - u, short, RIGHT)
            left = comb_voltage(p.second_v - u, short, LEFT)
            right, left = right * right, left * left
            drag = 0.0
            if rubbing > 0.0:
                net = slaved_force(p, q, right, left) + push(p, q, 0.0) - k * q + outside
                if v == 0.0 and abs(net) <= rubbing:
                    continue
                drag = dry_friction(rubbing, v, net)
            before = v
            held = outside + drag
            a1 = (slaved_force(p, q, right, left) + push(p, q, v) - k * q - b * v + held) / m
            q2, v2 = q + 0.5 * h * v, v + 0.5 * h * a1
            a2 = (slaved_force(p, q2, right, left) + push(p, q2, v2) - k * q2 - b * v2 + held) / m
            q3, v3 = q + 0.5 * h * v2, v + 0.5 * h * a2
            a3 = (slaved_force(p, q3, right, left) + push(p, q3, v3) - k * q3 - b * v3 + held) / m
            q4, v4 = q + h * v3, v + h * a3
            a4 = (slaved_force(p, q4, right, left) + push(p, q4, v4) - k * q4 - b * v4 + held) / m
            q += h * (v + 2.0 * (v2 + v3) + v4) / 6.0
            v += h * (a1 + 2.0 * (a2 + a3) + a4) / 6.0
            if rubbing > 0.0 and before * v < 0.0:
                v = 0.0
            if abs(p.ratio * q) > p.touch_um:
                x.contact = 1.0
                if s.touched_ms < 0.0:
                    s.touched_ms = (x.tick - 1.0) * p.dt_ms + (i + 1) * h
                if p.short_on_contact != 0.0:
                    short = joined(short, RIGHT + LEFT)
        x.displacement = flush_tiny(q)
        x.velocity = flush_tiny(v)
        x.lateral = p.ratio * q
        x.shift = p.ratio * q
        x.shift_velocity = p.ratio * v
        x.short = short


@kernel
def slaved_force(p: SlavedLateral.Packed, x: float, right: float, left: float) -> float:
    r"""Return the electrostatic force, uN; ``right`` and ``left`` are squared voltages.

    .. math:: \tfrac12n\varepsilon_0t\{V_1^2[G+\kappa G'(L+x)]+V_2^2[-G+\kappa G'(L-x)]\},\quad
        G=\frac{2g}{g^2-\eta^2},\quad G'=\frac{4g\eta}{(g^2-\eta^2)^2},\quad\eta=\kappa x
    """
    eta = p.ratio * x
    inside = min(max(eta, -p.limit), p.limit)
    r = 1.0 / (p.gap * p.gap - inside * inside)
    slope = 4.0 * p.gap * inside * r * r
    whole = 2.0 * p.gap * r + slope * (eta - inside)
    tied = p.ratio * slope
    strength = 0.25 * p.capacitance_gradient * p.gap
    pulled = right * (whole + tied * max(p.effective_overlap_um + x, 0.0)) + left * (
        tied * max(p.effective_overlap_um - x, 0.0) - whole
    )
    return float(strength * pulled)


@kernel
def push(p: SlavedLateral.Packed, x: float, v: float) -> float:
    """Return the force of the stops and of touching fingers, uN."""
    return float(stop(p, x, v) + p.ratio * touch(p, p.ratio * x, p.ratio * v))
