"""Plant whose sideways motion is tied to its travel: a calibration to the text, not physics."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, kernel, parameter, settled
from core.plant.contact import GAP, LIMIT, PLANT, SHORTS, TOUCH, ContactParams, resolved_us, stop, touch
from core.plant.shuttle import (
    ACCELERATION,
    COMB,
    CONTACT,
    DAMPING,
    DAMPING_SCALE,
    DISPLACEMENT,
    DT,
    FIRST_OWN_INPUT,
    FIRST_V,
    FRICTION,
    LATERAL,
    LEFT,
    MASS,
    MASS_SCALE,
    RIGHT,
    SECOND_V,
    SHIFT,
    SHIFT_VELOCITY,
    SHORT,
    SHORTED,
    STIFFNESS_SCALE,
    V0,
    VELOCITY,
    X0,
    Shuttle,
    at_rest_sideways,
    comb_voltage,
    comb_voltage_parabola,
    drive_noise,
    dry_friction,
    joined,
    thermal_force,
)

SPRING, KAPPA, OVERLAP, SUBSTEPS = range(PLANT, PLANT + 4)
FIRST_OUTPUT = FIRST_OWN_INPUT


@kernel
def slaved_force(p: Any, x: float, right: float, left: float) -> float:
    r"""Return the electrostatic force, uN; ``right`` and ``left`` are squared voltages.

    .. math:: \tfrac12n\varepsilon_0t\{V_1^2[G+\kappa G'(L+x)]+V_2^2[-G+\kappa G'(L-x)]\},\quad
        G=\frac{2g}{g^2-\eta^2},\quad G'=\frac{4g\eta}{(g^2-\eta^2)^2},\quad\eta=\kappa x
    """
    eta = p[KAPPA] * x
    inside = min(max(eta, -p[LIMIT]), p[LIMIT])
    r = 1.0 / (p[GAP] * p[GAP] - inside * inside)
    slope = 4.0 * p[GAP] * inside * r * r
    whole = 2.0 * p[GAP] * r + slope * (eta - inside)
    tied = p[KAPPA] * slope
    strength = 0.25 * p[COMB] * p[GAP]
    pulled = right * (whole + tied * max(p[OVERLAP] + x, 0.0)) + left * (tied * max(p[OVERLAP] - x, 0.0) - whole)
    return float(strength * pulled)


@kernel
def push(p: Any, x: float, v: float) -> float:
    """Return the force of the stops and of touching fingers, uN."""
    return float(stop(p, x, v) + p[KAPPA] * touch(p, p[KAPPA] * x, p[KAPPA] * v))


def slaved_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance over the interval that ends now by Runge-Kutta substeps."""
    out = FIRST_OUTPUT
    short = joined(w[io[out + SHORT]], w[io[SHORTED]])
    at_rest_sideways(w, io, out, short)
    x = w[io[out + DISPLACEMENT]]
    v = w[io[out + VELOCITY]]
    n = int(p[SUBSTEPS])
    if w[TICK] == 0.0:
        x, v, n = p[X0], p[V0], 0
    m = p[MASS] * w[io[MASS_SCALE]]
    b = p[DAMPING] * w[io[DAMPING_SCALE]]
    k = p[SPRING] * w[io[STIFFNESS_SCALE]]
    u0, rise, bend = comb_voltage_parabola(w, io)
    other = -m * w[io[ACCELERATION]]
    if n > 0:
        u0 += drive_noise(p, w[TICK] - 1.0)
        other += thermal_force(p, b, w[TICK] - 1.0)
    rubbing = w[io[FRICTION]]
    for i in range(n):
        h = p[DT] / n
        # the voltage of the middle of the substep: it changes little over a quarter of a microsecond
        a = (i + 0.5) / n
        u = u0 + a * (rise + a * bend)
        right = comb_voltage(p[FIRST_V] - u, short, RIGHT)
        left = comb_voltage(p[SECOND_V] - u, short, LEFT)
        right, left = right * right, left * left
        drag = 0.0
        if rubbing > 0.0:
            net = slaved_force(p, x, right, left) + push(p, x, 0.0) - k * x + other
            if v == 0.0 and abs(net) <= rubbing:
                continue
            drag = dry_friction(rubbing, v, net)
        before = v
        held = other + drag
        a1 = (slaved_force(p, x, right, left) + push(p, x, v) - k * x - b * v + held) / m
        x2, v2 = x + 0.5 * h * v, v + 0.5 * h * a1
        a2 = (slaved_force(p, x2, right, left) + push(p, x2, v2) - k * x2 - b * v2 + held) / m
        x3, v3 = x + 0.5 * h * v2, v + 0.5 * h * a2
        a3 = (slaved_force(p, x3, right, left) + push(p, x3, v3) - k * x3 - b * v3 + held) / m
        x4, v4 = x + h * v3, v + h * a3
        a4 = (slaved_force(p, x4, right, left) + push(p, x4, v4) - k * x4 - b * v4 + held) / m
        x += h * (v + 2.0 * (v2 + v3) + v4) / 6.0
        v += h * (a1 + 2.0 * (a2 + a3) + a4) / 6.0
        if rubbing > 0.0 and before * v < 0.0:
            v = 0.0
        if abs(p[KAPPA] * x) > p[TOUCH]:
            w[io[out + CONTACT]] = 1.0
            if s[0] < 0.0:
                s[0] = (w[TICK] - 1.0) * p[DT] + (i + 1) * h
            if p[SHORTS] != 0.0:
                short = joined(short, RIGHT + LEFT)
    w[io[out + DISPLACEMENT]] = settled(x)
    w[io[out + VELOCITY]] = settled(v)
    w[io[out + LATERAL]] = p[KAPPA] * x
    w[io[out + SHIFT]] = p[KAPPA] * x
    w[io[out + SHIFT_VELOCITY]] = p[KAPPA] * v
    w[io[out + SHORT]] = short


class SlavedLateral(Shuttle):
    r"""Sideways motion tied to the travel, :math:`\eta=\kappa x`: a calibration to the text's 1.67 um, not physics.

    .. math:: m\ddot x=-k_1x-\beta\dot x+\tfrac12n\varepsilon_0t\left\{V_1^2[G+\kappa G'(L+x)]
        +V_2^2[-G+\kappa G'(L-x)]\right\}

    The text turns the shuttle about the point of adhesion as about a rigid pivot and loses stability at a third of the
    gap. Elasticity gives a hundredth of that rotation (see the planar plant); with the overlap shortened to 5 um this
    plant folds where the text has it, so that its controllers can be tried on it. With the whole overlap of 40 um
    the same kinematics would be unstable at rest beyond 4.1 V of bias.
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

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        mass = context.device.mass
        step = params.stop_step_us(params.step_us, mass)
        if params.ratio > 0.0:
            # fingers feel the shuttle through the lever of their motion
            felt = mass / (params.ratio * params.ratio)
            step = resolved_us(step, params.contact_stiffness_n_m, params.contact_damping_ns_m * 1e3, felt)
        own = [
            *params.packed(context),
            params.stiffness_n_m,
            params.ratio,
            params.effective_overlap_um,
            float(math.ceil(context.dt_ms * 1e3 / step - 1e-9)),
        ]
        return np.array(cls.shared(params, context) + own, dtype=np.float64)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Time of the first contact."""
        return np.full(1, -1.0)

    step = slaved_step
