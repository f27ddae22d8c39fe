"""The rigid shuttle in the plane: its elasticity and dampings of a sample, its heat, the forces at one point."""

from __future__ import annotations

import math
from typing import Any

from core.block import inlined, kernel
from core.plant.contact import LIMIT, TOUCH, stop, touch
from core.plant.electrostatics import comb
from core.plant.plane import (
    CUBIC,
    GAP_SQUARED,
    PER_GAP,
    PER_INERTIA,
    ROTOR,
    SIDE_DAMPING,
    SIDE_REACH,
    SIDE_STIFFNESS,
    SIDEWAYS,
    SQUEEZE,
    STATOR,
    STRENGTH,
    T_MISS,
    TURN,
    TURN_CUBIC,
    TURN_DAMPING,
    TURN_REACH,
    TURN_STIFFNESS,
    Y_MISS,
)
from core.plant.shuttle import DAMPING, DAMPING_SCALE, FIRST_OWN_INPUT, MASS, MASS_SCALE, STIFFNESS, STIFFNESS_SCALE
from core.plant.suspension import K1, K3, KT, KY, T1, T3, XT, XY, Y2, elastic_force

(
    ACCELERATION_SIDE,
    CUBIC_IN,
    SIDE_SCALE,
    SIDE_REACH_SCALE,
    TURN_SCALE,
    TURN_REACH_SCALE,
    SIDEWAYS_IN,
    TURN_IN,
    TURN_CUBIC_IN,
    SQUEEZE_IN,
    ELASTICITY_IN,
    FIRST_OUTPUT,
) = range(FIRST_OWN_INPUT, FIRST_OWN_INPUT + 12)
"""Input ports of the plant in the plane, behind those of every plant."""

PER_MASS, BETA, C_SIDE, C_TURN, C_SQUEEZE, F_X, F_Y, TOUCHED_MS = range(9, 17)
"""State, behind the suspension of this sample: one over its mass, dampings, outer forces; time of the first contact."""


@kernel
def prepare(p: Any, s: Any, w: Any, io: Any) -> None:
    """Put the suspension, the mass and the dampings as they are now into the state."""
    travel = w[io[SIDE_REACH_SCALE]] * p[SIDE_REACH]
    turning = w[io[TURN_REACH_SCALE]] * p[TURN_REACH]
    elasticity = w[io[ELASTICITY_IN]]
    s[K1] = p[STIFFNESS] * w[io[STIFFNESS_SCALE]]
    s[K3] = elasticity * (p[CUBIC] + w[io[CUBIC_IN]])
    s[KY] = elasticity * (p[SIDE_STIFFNESS] * w[io[SIDE_SCALE]])
    s[XY] = 1.0 / (travel * travel)
    s[KT] = elasticity * (p[TURN_STIFFNESS] * w[io[TURN_SCALE]])
    s[XT] = 1.0 / (turning * turning)
    s[Y2] = p[SIDEWAYS] + w[io[SIDEWAYS_IN]]
    s[T1] = p[TURN] + w[io[TURN_IN]]
    s[T3] = p[TURN_CUBIC] + w[io[TURN_CUBIC_IN]]
    s[PER_MASS] = 1.0 / (p[MASS] * w[io[MASS_SCALE]])
    s[BETA] = p[DAMPING] * w[io[DAMPING_SCALE]]
    s[C_SIDE] = p[SIDE_DAMPING] * w[io[DAMPING_SCALE]]
    s[C_TURN] = p[TURN_DAMPING] * w[io[DAMPING_SCALE]]
    s[C_SQUEEZE] = p[SQUEEZE] * w[io[DAMPING_SCALE]] * w[io[SQUEEZE_IN]]


@inlined
def squeeze_factor(r: float) -> float:
    r"""Return :math:`\tfrac12[(1-u)^{-3}+(1+u)^{-3}]=r^2(4r-3)` from :math:`r=1/(1-u^2)`."""
    return r * r * (4.0 * r - 3.0)


@kernel
def noise_of(p: Any, s: Any, y: float, theta: float) -> tuple[float, float, float]:
    """Return the Cholesky factor of the dampings of y and theta: coupled once the arms differ, and so is their noise.

    ``l11``, ``l21``, ``l22``, roots of uN ms/um with a lever in um.
    """
    arm = 0.5 * (p[ROTOR] + p[STATOR])
    yy = p[PER_GAP] * min(max(y + p[Y_MISS], -p[LIMIT]), p[LIMIT])
    lever = p[PER_GAP] * min(max((theta + p[T_MISS]) * arm, -p[LIMIT]), p[LIMIT])
    u1 = min(max(yy + lever, -0.9), 0.9)
    u2 = min(max(yy - lever, -0.9), 0.9)
    c1 = s[C_SQUEEZE] * squeeze_factor(1.0 / (1.0 - u1 * u1))
    c2 = s[C_SQUEEZE] * squeeze_factor(1.0 / (1.0 - u2 * u2))
    l11 = math.sqrt(s[C_SIDE] + c1 + c2)
    l21 = arm * (c1 - c2) / l11 if l11 > 0.0 else 0.0
    return l11, l21, math.sqrt(max(s[C_TURN] + arm * arm * (c1 + c2) - l21 * l21, 0.0))


@inlined
def acceleration(
    p: Any,
    s: Any,
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
    fx, fy, mz = elastic_force(s, x, y, theta)
    yy = y + p[Y_MISS]
    tt = theta + p[T_MISS]
    half = 0.5 * (p[ROTOR] - p[STATOR] + x)
    x1, y1, t1, middle1, r1 = comb(p[GAP_SQUARED], p[LIMIT], p[STATOR], half, 1.0, yy, tt)
    half = p[ROTOR] - p[STATOR] - half
    x2, y2, t2, middle2, r2 = comb(p[GAP_SQUARED], p[LIMIT], p[STATOR], half, -1.0, yy, tt)
    first = p[STRENGTH] * right
    second = p[STRENGTH] * left
    drag1 = s[C_SQUEEZE] * squeeze_factor(p[GAP_SQUARED] * r1) * (vy + omega * middle1)
    drag2 = s[C_SQUEEZE] * squeeze_factor(p[GAP_SQUARED] * r2) * (vy + omega * middle2)
    fx += (s[F_X] - s[BETA] * vx) + (first * x1 + second * x2) + stop(p, x, vx)
    fy += (s[F_Y] - s[C_SIDE] * vy) + ((first * y1 + second * y2) - (drag1 + drag2))
    mz += ((first * t1 + second * t2) - s[C_TURN] * omega) - (middle1 * drag1 + middle2 * drag2)
    if abs(yy) + abs(tt) * p[ROTOR] > p[TOUCH]:
        for i in range(4):
            corner = p[STATOR] if i < 2 else p[ROTOR]
            if i % 2 == 1:
                corner = -corner
            push = touch(p, yy + tt * corner, vy + omega * corner)
            fy += push
            mz += corner * push
    return fx * s[PER_MASS], fy * s[PER_MASS], mz * p[PER_INERTIA]


@kernel
def worst(p: Any, y: float, theta: float) -> float:
    """Return the lateral displacement of the corner where it is largest, um."""
    yy = y + p[Y_MISS]
    lever = (theta + p[T_MISS]) * p[ROTOR]
    return float(yy + lever if abs(yy + lever) >= abs(yy - lever) else yy - lever)
