"""Plant with hardening spring, friction and stops."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Port, kernel, parameter, settled
from core.plant.shuttle import (
    ACCELERATION,
    DISPLACEMENT,
    DT,
    ELASTICITY_PORT,
    FIRST_OWN_INPUT,
    FRICTION,
    OWN,
    SHORT,
    SHORTED,
    V0,
    VELOCITY,
    X0,
    Shuttle,
    ShuttleParams,
    at_rest_sideways,
    coefficients,
    comb_force,
    comb_voltage_parabola,
    drive_noise,
    dry_friction,
    joined,
    thermal_force,
    wall,
)

CUBIC, SMOOTHED, SLIP, STOP, STOP_STIFFNESS, STOP_DAMPING, SUBSTEPS, FINE, NEAR, SLOW = range(OWN, OWN + 10)
CUBIC_IN, ELASTICITY_IN, FIRST_OUTPUT = range(FIRST_OWN_INPUT, FIRST_OWN_INPUT + 3)
X_OUT, V_OUT, SHORT_OUT = FIRST_OUTPUT + DISPLACEMENT, FIRST_OUTPUT + VELOCITY, FIRST_OUTPUT + SHORT
RESOLVED = 0.2
"""Longest step at a stop or in smoothed friction, in units of one over the fastest rate there.

A few rebounds are then good to 3 % of the travel, against an adaptive solver; with 0.5 to 10 %, and 2.8 is unstable.
"""
MOST_PARTS = 1000
"""Most parts of a substep, so that a sample ends."""
SMOOTH = 4.0
"""Where smoothed friction is as good as constant, in slip velocities."""


@kernel
def acceleration(p: Any, m: float, b: float, k: float, cubic: float, x: float, v: float, force: float) -> float:
    """Return the acceleration at one point, um/ms^2."""
    total = force - b * v - k * x - cubic * x * x * x - p[SMOOTHED] * math.tanh(v / p[SLIP])
    return float((total + wall(p[STOP], p[STOP_STIFFNESS], p[STOP_DAMPING], x, v)) / m)


def nonlinear_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance over the interval that ends now by Runge-Kutta substeps."""
    short = joined(w[io[SHORT_OUT]], w[io[SHORTED]])
    at_rest_sideways(w, io, FIRST_OUTPUT, short)
    if w[TICK] == 0.0:
        w[io[X_OUT]] = p[X0]
        w[io[V_OUT]] = p[V0]
        return
    m, b, k = coefficients(p, w, io)
    cubic = w[io[ELASTICITY_IN]] * (p[CUBIC] + w[io[CUBIC_IN]])
    tick = w[TICK] - 1.0
    u0, rise, bend = comb_voltage_parabola(w, io)
    noise = drive_noise(p, tick)
    other = thermal_force(p, b, tick) - m * w[io[ACCELERATION]]
    rubbing = w[io[FRICTION]]
    whole = p[DT] / p[SUBSTEPS]
    fine = int(p[FINE])
    total = int(p[SUBSTEPS]) * fine
    x = w[io[X_OUT]]
    v = w[io[V_OUT]]
    done = 0
    while done < total:
        stride = fine if done % fine == 0 else 1
        a0 = done / total
        fa = comb_force(p, u0 + noise + a0 * (rise + a0 * bend), short) + other
        drag = 0.0
        if rubbing > 0.0:
            net = m * acceleration(p, m, b, k, cubic, x, 0.0, fa)
            if v == 0.0 and abs(net) <= rubbing:
                done += stride
                continue
            drag = dry_friction(rubbing, v, net)
            fa += drag
        k1 = acceleration(p, m, b, k, cubic, x, v, fa)
        # a whole substep, or one of its parts where the next might meet a stop or friction that turns
        gain = whole * abs(k1)
        if abs(x) + whole * (abs(v) + gain) > p[NEAR] or abs(v) - gain < p[SLOW]:
            stride = 1
        h = whole if stride == fine else whole / fine
        a1 = (done + 0.5 * stride) / total
        done += stride
        a2 = done / total
        fb = comb_force(p, u0 + noise + a1 * (rise + a1 * bend), short) + other + drag
        fc = comb_force(p, u0 + noise + a2 * (rise + a2 * bend), short) + other + drag
        before = v
        v2 = v + 0.5 * h * k1
        k2 = acceleration(p, m, b, k, cubic, x + 0.5 * h * v, v2, fb)
        v3 = v + 0.5 * h * k2
        k3 = acceleration(p, m, b, k, cubic, x + 0.5 * h * v2, v3, fb)
        v4 = v + h * k3
        k4 = acceleration(p, m, b, k, cubic, x + h * v3, v4, fc)
        x += h * (v + 2.0 * v2 + 2.0 * v3 + v4) / 6.0
        v += h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0
        if rubbing > 0.0 and before * v < 0.0:
            v = 0.0  # friction brings the shuttle to rest where it would turn
    w[io[X_OUT]] = settled(x)
    w[io[V_OUT]] = settled(v)


class Nonlinear(Shuttle):
    r"""Plant with cubic stiffness, dry friction and end stops.

    .. math:: m\ddot x=F_e-\beta\dot x-kx-k_3x^3-F_c\tanh(\dot x/v_s)-F_{stop}(x,\dot x)

    Classical Runge-Kutta with a fixed number of substeps, in parts where the shuttle meets a stop or friction turns:
    both may be faster than the sample. The plant's own friction is smoothed below the slip velocity; that of a fault
    holds the shuttle at rest.
    """

    title = "Nonlinear plant"
    inputs = (
        *Shuttle.inputs,
        Port("cubic", "uN/um^3", "added cubic stiffness", source="effects.cubic"),
        ELASTICITY_PORT,
    )
    equations = (
        Equation(
            "motion",
            r"m\ddot x=F_e-\beta\dot x-kx-k_3x^3-F_c\tanh\frac{\dot x}{v_s}-F_{stop}",
            "1.3.1 with a hardening spring, friction and stops",
        ),
        Equation("stop", r"F_{stop}=\left[k_s\,(|x|-x_s)\,\mathrm{sgn}\,x+c_s\dot x\right]\ \text{for}\ |x|>x_s"),
    )

    class Params(ShuttleParams):
        """Parameters of the nonlinear plant."""

        cubic_n_m3: float = parameter(1e7, "cubic stiffness k3", "N/m^3", ge=-1e10, le=1e12)
        friction_nn: float = parameter(0.0, "Coulomb friction", "nN", ge=0, le=1e5)
        slip_velocity_um_ms: float = parameter(0.05, "velocity below which friction is smoothed", "um/ms", gt=0)
        stop_um: float = parameter(20.0, "travel to the end stops", "um", gt=0)
        stop_stiffness_n_m: float = parameter(50.0, "stiffness of a stop", "N/m", ge=0, le=5e3)
        stop_damping_ns_m: float = parameter(2e-5, "damping of a stop", "N s/m", ge=0, le=1e-3)
        substeps: int = parameter(4, "Runge-Kutta steps in a sample", ge=1, le=64)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step: uN/um^3 is 1e-12 N/m^3, nN is 1e-3 uN."""
        substep = context.dt_ms / params.substeps
        mass = context.device.mass
        damping = params.stop_damping_ns_m * 1e3
        wall = max(math.sqrt(params.stop_stiffness_n_m / mass), damping / mass) * substep
        slope = params.friction_nn * 1e-3 / (params.slip_velocity_um_ms * mass) * substep
        own = [
            params.cubic_n_m3 * 1e-12,
            params.friction_nn * 1e-3,
            params.slip_velocity_um_ms,
            params.stop_um,
            params.stop_stiffness_n_m,
            damping,
            float(params.substeps),
            float(min(math.ceil(max(wall, slope, RESOLVED) / RESOLVED), MOST_PARTS)),
            params.stop_um if wall > RESOLVED else math.inf,
            SMOOTH * params.slip_velocity_um_ms if slope > RESOLVED else -math.inf,
        ]
        return np.array(cls.shared(params, context) + own, dtype=np.float64)

    step = nonlinear_step
