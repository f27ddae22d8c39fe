"""The rigid shuttle in the plane: elasticity, dampings and heat of a sample, and the forces at one point."""

from __future__ import annotations

import math

from core.kernel import kernel
from core.plant.contact import stop, touch
from core.plant.electrostatics import comb
from core.plant.plane import Plane
from core.plant.suspension import elastic_force


@kernel
def prepare(p: Plane.Packed, s: Plane.State, x: Plane.Ports) -> None:
    """Write the present suspension, mass and dampings into the state."""
    k = s.suspension
    travel = x.lateral_reach * p.lateral_reach
    turning = x.rotation_reach * p.rotation_reach
    elasticity = x.elasticity_scale
    k.stiffness = p.stiffness * x.stiffness_scale
    k.cubic = elasticity * (p.cubic + x.cubic)
    k.lateral_stiffness = elasticity * (p.lateral_stiffness * x.lateral_scale)
    k.lateral_softening = 1.0 / (travel * travel)
    k.rotation_stiffness = elasticity * (p.rotation_stiffness * x.rotation_scale)
    k.rotation_softening = 1.0 / (turning * turning)
    k.sideways = p.sideways + x.sideways
    k.turn = p.turn + x.turn
    k.turn_cubic = p.turn_cubic + x.turn_cubic
    s.per_mass = 1.0 / (p.mass * x.mass_scale)
    s.damping = p.damping * x.damping_scale
    s.lateral_damping = p.lateral_damping * x.damping_scale
    s.rotation_damping = p.rotation_damping * x.damping_scale
    s.squeeze = p.squeeze * x.damping_scale * x.squeeze_scale


@kernel
def squeeze_factor(r: float) -> float:
    r"""Return :math:`\tfrac12[(1-u)^{-3}+(1+u)^{-3}]=r^2(4r-3)` from :math:`r=1/(1-u^2)`."""
    return r * r * (4.0 * r - 3.0)


@kernel
def noise_of(p: Plane.Packed, s: Plane.State, y: float, theta: float) -> tuple[float, float, float]:
    """Return the Cholesky factor of the dampings of y and theta, which couple, with their noise, once the arms differ.

    ``l11``, ``l21``, ``l22``, roots of uN ms/um with a lever in um.
    """
    arm = 0.5 * (p.rotor_tip + p.stator_tip)
    yy = p.per_gap * min(max(y + p.misalignment_um, -p.limit), p.limit)
    lever = p.per_gap * min(max((theta + p.misalignment_rad) * arm, -p.limit), p.limit)
    u1 = min(max(yy + lever, -0.9), 0.9)
    u2 = min(max(yy - lever, -0.9), 0.9)
    c1 = s.squeeze * squeeze_factor(1.0 / (1.0 - u1 * u1))
    c2 = s.squeeze * squeeze_factor(1.0 / (1.0 - u2 * u2))
    l11 = math.sqrt(s.lateral_damping + c1 + c2)
    l21 = arm * (c1 - c2) / l11 if l11 > 0.0 else 0.0
    return l11, l21, math.sqrt(max(s.rotation_damping + arm * arm * (c1 + c2) - l21 * l21, 0.0))


@kernel
def acceleration(
    p: Plane.Packed,
    s: Plane.State,
    x: float,
    y: float,
    theta: float,
    vx: float,
    vy: float,
    omega: float,
    right: float,
    left: float,
) -> tuple[float, float, float]:
    """Return the accelerations along x, y and in rotation; ``right`` and ``left`` are squared voltages."""
    fx, fy, mz = elastic_force(s.suspension, x, y, theta)
    yy = y + p.misalignment_um
    tt = theta + p.misalignment_rad
    half = 0.5 * (p.rotor_tip - p.stator_tip + x)
    x1, y1, t1, middle1, r1 = comb(p.gap_squared, p.limit, p.stator_tip, half, 1.0, yy, tt)
    half = p.rotor_tip - p.stator_tip - half
    x2, y2, t2, middle2, r2 = comb(p.gap_squared, p.limit, p.stator_tip, half, -1.0, yy, tt)
    first = p.strength * right
    second = p.strength * left
    drag1 = s.squeeze * squeeze_factor(p.gap_squared * r1) * (vy + omega * middle1)
    drag2 = s.squeeze * squeeze_factor(p.gap_squared * r2) * (vy + omega * middle2)
    fx += (s.force_x - s.damping * vx) + (first * x1 + second * x2) + stop(p, x, vx)
    fy += (s.force_y - s.lateral_damping * vy) + ((first * y1 + second * y2) - (drag1 + drag2))
    mz += ((first * t1 + second * t2) - s.rotation_damping * omega) - (middle1 * drag1 + middle2 * drag2)
    if abs(yy) + abs(tt) * p.rotor_tip > p.touch_um:
        for i in range(4):
            corner = p.stator_tip if i < 2 else p.rotor_tip
            if i % 2 == 1:
                corner = -corner
            push = touch(p, yy + tt * corner, vy + omega * corner)
            fy += push
            mz += corner * push
    return fx * s.per_mass, fy * s.per_mass, mz * p.per_inertia


@kernel
def worst(p: Plane.Packed, y: float, theta: float) -> float:
    """Return the largest lateral displacement of a corner, um."""
    yy = y + p.misalignment_um
    lever = (theta + p.misalignment_rad) * p.rotor_tip
    return float(yy + lever if abs(yy + lever) >= abs(yy - lever) else yy - lever)
