"""Plant with hardening spring, friction and stops."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, kernel, parameter, settled
from core.plant.shuttle import (
    DAMPING,
    DAMPING_SCALE,
    DISPLACEMENT,
    DT,
    END,
    MASS,
    MASS_SCALE,
    MIDDLE,
    OWN,
    STIFFNESS,
    STIFFNESS_SCALE,
    V0,
    VELOCITY,
    VOLTAGE,
    X0,
    Shuttle,
    ShuttleParams,
    comb_force,
    drive_noise,
    thermal_force,
)

CUBIC, FRICTION, SLIP, STOP, STOP_STIFFNESS, STOP_DAMPING, SUBSTEPS = range(OWN, OWN + 7)


@kernel
def acceleration(p: Any, m: float, b: float, k: float, x: float, v: float, force: float) -> float:
    """Return the acceleration at one point, um/ms^2."""
    total = force - b * v - k * x - p[CUBIC] * x * x * x - p[FRICTION] * math.tanh(v / p[SLIP])
    over = abs(x) - p[STOP]
    if over > 0.0:
        push = p[STOP_STIFFNESS] * over
        total -= (push if x > 0.0 else -push) + p[STOP_DAMPING] * v
    return float(total / m)


def nonlinear_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance over the interval that ends now by Runge-Kutta substeps."""
    if w[TICK] == 0.0:
        w[io[DISPLACEMENT]] = p[X0]
        w[io[VELOCITY]] = p[V0]
        return
    m = p[MASS] * w[io[MASS_SCALE]]
    b = p[DAMPING] * w[io[DAMPING_SCALE]]
    k = p[STIFFNESS] * w[io[STIFFNESS_SCALE]]
    tick = w[TICK] - 1.0
    u0 = w[io[VOLTAGE]]
    rise = 4.0 * (w[io[MIDDLE]] - u0) - (w[io[END]] - u0)
    bend = 2.0 * (w[io[END]] - u0) - 4.0 * (w[io[MIDDLE]] - u0)
    noise = drive_noise(p, tick)
    thermal = thermal_force(p, b, tick)
    n = int(p[SUBSTEPS])
    h = p[DT] / n
    x = w[io[DISPLACEMENT]]
    v = w[io[VELOCITY]]
    for i in range(n):
        a0 = i / n
        a1 = (i + 0.5) / n
        a2 = (i + 1.0) / n
        fa = comb_force(p, u0 + noise + a0 * (rise + a0 * bend)) + thermal
        fb = comb_force(p, u0 + noise + a1 * (rise + a1 * bend)) + thermal
        fc = comb_force(p, u0 + noise + a2 * (rise + a2 * bend)) + thermal
        k1 = acceleration(p, m, b, k, x, v, fa)
        v2 = v + 0.5 * h * k1
        k2 = acceleration(p, m, b, k, x + 0.5 * h * v, v2, fb)
        v3 = v + 0.5 * h * k2
        k3 = acceleration(p, m, b, k, x + 0.5 * h * v2, v3, fb)
        v4 = v + h * k3
        k4 = acceleration(p, m, b, k, x + h * v3, v4, fc)
        x += h * (v + 2.0 * v2 + 2.0 * v3 + v4) / 6.0
        v += h * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0
    w[io[DISPLACEMENT]] = settled(x)
    w[io[VELOCITY]] = settled(v)


class Nonlinear(Shuttle):
    r"""Plant with cubic stiffness, dry friction and end stops.

    .. math:: m\ddot x=F_e-\beta\dot x-kx-k_3x^3-F_c\tanh(\dot x/v_s)-F_{stop}(x,\dot x)

    Classical Runge-Kutta with a fixed number of substeps; friction is smoothed below the slip velocity.
    """

    title = "Nonlinear plant"
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
        own = [
            params.cubic_n_m3 * 1e-12,
            params.friction_nn * 1e-3,
            params.slip_velocity_um_ms,
            params.stop_um,
            params.stop_stiffness_n_m,
            params.stop_damping_ns_m * 1e3,
            float(params.substeps),
        ]
        return np.array(cls.shared(params, context) + own, dtype=np.float64)

    step = nonlinear_step
