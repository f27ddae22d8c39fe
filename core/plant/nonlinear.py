"""Plant with hardening spring, friction and stops."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, parameter
from core.elementary import tanh
from core.kernel import flush_tiny, kernel
from core.plant.shuttle import (
    ELASTICITY,
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
from core.ports import reads
from core.record import Record

RESOLVED = 0.2
"""Longest step at a stop or in smoothed friction, in units of one over the fastest rate there.

A few rebounds are then accurate to 3 % of the travel, compared with an adaptive solver; with 0.5 the error is 10 %, and
2.8 is unstable.
"""
MOST_PARTS = 1000
"""Largest number of parts of a substep, so that a sample takes a finite number of them."""
SMOOTH = 4.0
"""Speed beyond which smoothed friction is practically constant, in slip velocities."""


class Nonlinear(Shuttle):
    r"""Plant with cubic stiffness, dry friction and end stops.

    .. math:: m\ddot x=F_e-\beta\dot x-kx-k_3x^3-F_c\tanh(\dot x/v_s)-F_{stop}(x,\dot x)

    Classical Runge-Kutta with a fixed number of substeps, in parts where the shuttle meets a stop or friction turns:
    both may be faster than the sample. The plant's own friction is smoothed below the slip velocity; the friction of a
    fault holds the shuttle without slip.
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

    class Packed(Shuttle.Packed):
        """Spring, friction and stops, the division of a sample, and the places that need a finer one."""

        cubic: float
        smoothed_friction: float
        slip_velocity_um_ms: float
        stop_um: float
        stop_stiffness_n_m: float
        stop_damping: float
        substeps: float
        parts: float
        near_stop_um: float
        slow_um_ms: float

    class Ports(Shuttle.Ports):
        """Effects that change its elasticity."""

        cubic: float = reads("effects.cubic", "uN/um^3", "added cubic stiffness")
        elasticity_scale: float = ELASTICITY

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step: uN/um^3 is 1e-12 N/m^3, nN is 1e-3 uN."""
        substep = context.dt_ms / params.substeps
        mass = context.device.mass
        damping = params.stop_damping_ns_m * 1e3
        wall = max(math.sqrt(params.stop_stiffness_n_m / mass), damping / mass) * substep
        slope = params.friction_nn * 1e-3 / (params.slip_velocity_um_ms * mass) * substep
        p: Nonlinear.Packed = super().pack(params, context)
        p.cubic = params.cubic_n_m3 * 1e-12
        p.smoothed_friction = params.friction_nn * 1e-3
        p.stop_damping = damping
        p.parts = float(min(math.ceil(max(wall, slope, RESOLVED) / RESOLVED), MOST_PARTS))
        p.near_stop_um = params.stop_um if wall > RESOLVED else math.inf
        p.slow_um_ms = SMOOTH * params.slip_velocity_um_ms if slope > RESOLVED else -math.inf
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Advance over the interval that ends now by Runge-Kutta substeps."""
        short = joined(x.short, x.shorted)
        at_rest_sideways(x, short)
        if x.tick == 0.0:
            x.displacement = p.initial_displacement_um
            x.velocity = p.initial_velocity_um_ms
            return
        m, b, k = coefficients(p, x)
        inverse_mass = 1.0 / m  # a division takes longer than the rest of an acceleration
        cubic = x.elasticity_scale * (p.cubic + x.cubic)
        tick = x.tick - 1.0
        u0, rise, bend = comb_voltage_parabola(x)
        noise = drive_noise(p, tick)
        outside = thermal_force(p, b, tick) - m * x.acceleration
        rubbing = x.friction
        whole = p.dt_ms / p.substeps
        fine = int(p.parts)
        total = int(p.substeps) * fine
        q = x.displacement
        v = x.velocity
        done = 0
        while done < total:
            stride = fine if done % fine == 0 else 1
            a0 = done / total
            fa = comb_force(p, u0 + noise + a0 * (rise + a0 * bend), short) + outside
            drag = 0.0
            if rubbing > 0.0:
                net = m * acceleration(p, inverse_mass, b, k, cubic, q, 0.0, fa)
                if v == 0.0 and abs(net) <= rubbing:
                    done += stride
                    continue
                drag = dry_friction(rubbing, v, net)
                fa += drag
            k1 = acceleration(p, inverse_mass, b, k, cubic, q, v, fa)
            # a whole substep, or one of its parts if the whole might meet a stop or a turn of the friction
            gain = whole * abs(k1)
            if abs(q) + whole * (abs(v) + gain) > p.near_stop_um or abs(v) - gain < p.slow_um_ms:
                stride = 1
            h = whole if stride == fine else whole / fine
            a1 = (done + 0.5 * stride) / total
            done += stride
            a2 = done / total
            fb = comb_force(p, u0 + noise + a1 * (rise + a1 * bend), short) + outside + drag
            fc = comb_force(p, u0 + noise + a2 * (rise + a2 * bend), short) + outside + drag
            before = v
            v2 = v + 0.5 * h * k1
            k2 = acceleration(p, inverse_mass, b, k, cubic, q + 0.5 * h * v, v2, fb)
            v3 = v + 0.5 * h * k2
            k3 = acceleration(p, inverse_mass, b, k, cubic, q + 0.5 * h * v2, v3, fb)
            v4 = v + h * k3
            k4 = acceleration(p, inverse_mass, b, k, cubic, q + h * v3, v4, fc)
            sixth = h * (1.0 / 6.0)
            q += sixth * (v + 2.0 * v2 + 2.0 * v3 + v4)
            v += sixth * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            if rubbing > 0.0 and before * v < 0.0:
                v = 0.0  # friction brings the shuttle to rest where it would turn
        x.displacement = flush_tiny(q)
        x.velocity = flush_tiny(v)


@kernel
def acceleration(
    p: Nonlinear.Packed, inverse_mass: float, b: float, k: float, cubic: float, x: float, v: float, force: float
) -> float:
    """Return the acceleration at one point, um/ms^2; ``inverse_mass`` is one over the mass."""
    total = force - b * v - k * x - cubic * x * x * x
    if p.smoothed_friction != 0.0:  # most plants have none, and it takes longer than all the rest
        total -= p.smoothed_friction * tanh(v / p.slip_velocity_um_ms)
    return float((total + wall(p.stop_um, p.stop_stiffness_n_m, p.stop_damping, x, v)) * inverse_mass)
