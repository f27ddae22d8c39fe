"""Plant in the plane: along x, sideways and in rotation, with pull-in, contact and short circuit."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Port, inlined, kernel, settled
from core.noise import normal
from core.plant.electrostatics import comb
from core.plant.plane import (
    COARSE,
    CUBIC,
    FINE,
    GAP_SQUARED,
    LIMIT,
    NEAR,
    PER_GAP,
    PER_INERTIA,
    ROTOR,
    SHORTS,
    SIDE_DAMPING,
    SIDE_KEY,
    SIDE_REACH,
    SIDE_STIFFNESS,
    SIDEWAYS,
    SQUEEZE,
    STATOR,
    STOP,
    STOP_DAMPING,
    STOP_STIFFNESS,
    STRENGTH,
    T_MISS,
    THERMAL_COARSE,
    THERMAL_FINE,
    TOUCH,
    TOUCH_DAMPING,
    TOUCH_STIFFNESS,
    TURN,
    TURN_CUBIC,
    TURN_DAMPING,
    TURN_KEY,
    TURN_REACH,
    TURN_STIFFNESS,
    Y_MISS,
    PlaneParams,
    packed,
)
from core.plant.shuttle import (
    ACCELERATION,
    CONTACT,
    DAMPING,
    DAMPING_SCALE,
    DISPLACEMENT,
    DRIVE_GAIN,
    DRIVE_OFFSET,
    DT,
    END,
    FIRST_OWN_INPUT,
    FIRST_V,
    FRICTION,
    LATERAL,
    LEFT,
    MASS,
    MASS_SCALE,
    MIDDLE,
    RIGHT,
    ROTATION,
    ROTATION_VELOCITY,
    SECOND_V,
    SHIFT,
    SHIFT_VELOCITY,
    SHORT,
    SHORTED,
    STIFFNESS,
    STIFFNESS_SCALE,
    V0,
    VELOCITY,
    VOLTAGE,
    X0,
    Shuttle,
    comb_voltage,
    drive_noise,
    dry_friction,
    joined,
    thermal_force,
)
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
    FIRST_OUTPUT,
) = range(FIRST_OWN_INPUT, FIRST_OWN_INPUT + 10)
PER_MASS, BETA, C_SIDE, C_TURN, C_SQUEEZE, F_X, F_Y, TOUCHED_MS = range(9, 17)
"""State: the suspension of this sample; one over its mass, dampings, outer forces; the time of the first contact."""


@inlined
def squeeze_factor(r: float) -> float:
    r"""Return :math:`\tfrac12[(1-u)^{-3}+(1+u)^{-3}]=r^2(4r-3)` from :math:`r=1/(1-u^2)`."""
    return r * r * (4.0 * r - 3.0)


@kernel
def touch(p: Any, corner: float, eta: float, rate: float) -> float:
    """Return the force of a stator on the fingers at one corner, uN."""
    over = abs(eta) - p[TOUCH]
    if over <= 0.0:
        return 0.0
    push = p[TOUCH_STIFFNESS] * over
    return float((-push if eta > 0.0 else push) - p[TOUCH_DAMPING] * rate)


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
    fx += (s[F_X] - s[BETA] * vx) + (first * x1 + second * x2)
    fy += (s[F_Y] - s[C_SIDE] * vy) + ((first * y1 + second * y2) - (drag1 + drag2))
    mz += ((first * t1 + second * t2) - s[C_TURN] * omega) - (middle1 * drag1 + middle2 * drag2)
    if abs(yy) + abs(tt) * p[ROTOR] > p[TOUCH]:
        for i in range(4):
            corner = p[STATOR] if i < 2 else p[ROTOR]
            if i % 2 == 1:
                corner = -corner
            push = touch(p, corner, yy + tt * corner, vy + omega * corner)
            fy += push
            mz += corner * push
    over = abs(x) - p[STOP]
    if over > 0.0:
        push = p[STOP_STIFFNESS] * over
        fx -= (push if x > 0.0 else -push) + p[STOP_DAMPING] * vx
    return fx * s[PER_MASS], fy * s[PER_MASS], mz * p[PER_INERTIA]


@kernel
def worst(p: Any, y: float, theta: float) -> float:
    """Return the lateral displacement of the corner where it is largest, um."""
    yy = y + p[Y_MISS]
    lever = (theta + p[T_MISS]) * p[ROTOR]
    return float(yy + lever if abs(yy + lever) >= abs(yy - lever) else yy - lever)


def planar_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance over the interval that ends now by Runge-Kutta substeps."""
    out = FIRST_OUTPUT
    short = joined(w[io[out + SHORT]], w[io[SHORTED]])
    w[io[out + CONTACT]] = 0.0
    x = w[io[out + DISPLACEMENT]]
    y = w[io[out + SHIFT]]
    theta = 1e-3 * w[io[out + ROTATION]]
    vx = w[io[out + VELOCITY]]
    vy = w[io[out + SHIFT_VELOCITY]]
    omega = 1e-3 * w[io[out + ROTATION_VELOCITY]]
    if w[TICK] == 0.0:
        x, vx, y, vy, theta, omega = p[X0], p[V0], 0.0, 0.0, 0.0, 0.0
    # the suspension, as it is now
    travel = w[io[SIDE_REACH_SCALE]] * p[SIDE_REACH]
    turning = w[io[TURN_REACH_SCALE]] * p[TURN_REACH]
    s[K1] = p[STIFFNESS] * w[io[STIFFNESS_SCALE]]
    s[K3] = p[CUBIC] + w[io[CUBIC_IN]]
    s[KY] = p[SIDE_STIFFNESS] * w[io[SIDE_SCALE]]
    s[XY] = 1.0 / (travel * travel)
    s[KT] = p[TURN_STIFFNESS] * w[io[TURN_SCALE]]
    s[XT] = 1.0 / (turning * turning)
    s[Y2] = p[SIDEWAYS] + w[io[SIDEWAYS_IN]]
    s[T1] = p[TURN] + w[io[TURN_IN]]
    s[T3] = p[TURN_CUBIC] + w[io[TURN_CUBIC_IN]]
    m = p[MASS] * w[io[MASS_SCALE]]
    s[PER_MASS] = 1.0 / m
    s[BETA] = p[DAMPING] * w[io[DAMPING_SCALE]]
    s[C_SIDE] = p[SIDE_DAMPING] * w[io[DAMPING_SCALE]]
    s[C_TURN] = p[TURN_DAMPING] * w[io[DAMPING_SCALE]]
    s[C_SQUEEZE] = p[SQUEEZE] * w[io[DAMPING_SCALE]]
    tick = w[TICK] - 1.0
    noise_x = 0.0
    l11 = 0.0
    l21 = 0.0
    l22 = 0.0
    if p[THERMAL_COARSE] > 0.0 and tick >= 0.0:
        noise_x = thermal_force(p, s[BETA], tick)
        # the dampings of y and theta are coupled once the arms differ; their noise is, too (Cholesky)
        arm = 0.5 * (p[ROTOR] + p[STATOR])
        yy = p[PER_GAP] * min(max(y + p[Y_MISS], -p[LIMIT]), p[LIMIT])
        lever = p[PER_GAP] * min(max((theta + p[T_MISS]) * arm, -p[LIMIT]), p[LIMIT])
        u1 = min(max(yy + lever, -0.9), 0.9)
        u2 = min(max(yy - lever, -0.9), 0.9)
        c1 = s[C_SQUEEZE] * squeeze_factor(1.0 / (1.0 - u1 * u1))
        c2 = s[C_SQUEEZE] * squeeze_factor(1.0 / (1.0 - u2 * u2))
        l11 = math.sqrt(s[C_SIDE] + c1 + c2)
        l21 = arm * (c1 - c2) / l11
        l22 = math.sqrt(s[C_TURN] + arm * arm * (c1 + c2) - l21 * l21)
    gain = w[io[DRIVE_GAIN]]
    u0 = gain * w[io[VOLTAGE]] + w[io[DRIVE_OFFSET]]
    d1 = gain * w[io[MIDDLE]] + w[io[DRIVE_OFFSET]] - u0
    d2 = gain * w[io[END]] + w[io[DRIVE_OFFSET]] - u0
    rise = 4.0 * d1 - d2
    bend = 2.0 * d2 - 4.0 * d1
    if tick >= 0.0:
        u0 += drive_noise(p, tick)
    rest_x = noise_x - m * w[io[ACCELERATION]]
    rest_y = -m * w[io[ACCELERATION_SIDE]]
    rubbing = w[io[FRICTION]]
    fine = int(p[FINE])
    total = int(p[COARSE]) * fine if tick >= 0.0 else 0
    done = 0
    while done < total:
        # one coarse substep, or a fine one of its parts while fingers are far off centre
        stride = fine if done % fine == 0 and abs(worst(p, y, theta)) < p[NEAR] else 1
        h = p[DT] * stride / total
        a0 = done / total
        a1 = (done + 0.5 * stride) / total
        done_next = done + stride
        a2 = done_next / total
        s[F_X] = rest_x
        s[F_Y] = rest_y
        kick = 0.0
        if p[THERMAL_COARSE] > 0.0:
            scale = p[THERMAL_COARSE] if stride == fine else p[THERMAL_FINE]
            count = tick * total + done
            n1 = scale * normal(p[SIDE_KEY], count)
            s[F_Y] = rest_y + l11 * n1
            kick = (l21 * n1 + l22 * scale * normal(p[TURN_KEY], count)) * p[PER_INERTIA]
        u = u0 + a0 * (rise + a0 * bend)
        r0 = comb_voltage(p[FIRST_V] - u, short, RIGHT)
        l0 = comb_voltage(p[SECOND_V] - u, short, LEFT)
        u = u0 + a1 * (rise + a1 * bend)
        r1 = comb_voltage(p[FIRST_V] - u, short, RIGHT)
        l1 = comb_voltage(p[SECOND_V] - u, short, LEFT)
        u = u0 + a2 * (rise + a2 * bend)
        r2 = comb_voltage(p[FIRST_V] - u, short, RIGHT)
        l2 = comb_voltage(p[SECOND_V] - u, short, LEFT)
        r0, l0, r1, l1, r2, l2 = r0 * r0, l0 * l0, r1 * r1, l1 * l1, r2 * r2, l2 * l2
        held = False
        if rubbing > 0.0:
            net = m * acceleration(p, s, x, y, theta, 0.0, vy, omega, r0, l0)[0]
            held = vx == 0.0 and abs(net) <= rubbing
            s[F_X] += dry_friction(rubbing, vx, net)
        g = 0.5 * h
        ax1, ay1, at1 = acceleration(p, s, x, y, theta, vx, vy, omega, r0, l0)
        at1 += kick
        vx2, vy2, om2 = vx + g * ax1, vy + g * ay1, omega + g * at1
        ax2, ay2, at2 = acceleration(p, s, x + g * vx, y + g * vy, theta + g * omega, vx2, vy2, om2, r1, l1)
        at2 += kick
        vx3, vy3, om3 = vx + g * ax2, vy + g * ay2, omega + g * at2
        ax3, ay3, at3 = acceleration(p, s, x + g * vx2, y + g * vy2, theta + g * om2, vx3, vy3, om3, r1, l1)
        at3 += kick
        vx4, vy4, om4 = vx + h * ax3, vy + h * ay3, omega + h * at3
        ax4, ay4, at4 = acceleration(p, s, x + h * vx3, y + h * vy3, theta + h * om3, vx4, vy4, om4, r2, l2)
        at4 += kick
        g = h / 6.0
        before = vx
        if not held:
            x += g * (vx + 2.0 * (vx2 + vx3) + vx4)
            vx += g * (ax1 + 2.0 * (ax2 + ax3) + ax4)
            if rubbing > 0.0 and before * vx < 0.0:
                vx = 0.0  # friction brings the shuttle to rest where it would turn
        y += g * (vy + 2.0 * (vy2 + vy3) + vy4)
        theta += g * (omega + 2.0 * (om2 + om3) + om4)
        vy += g * (ay1 + 2.0 * (ay2 + ay3) + ay4)
        omega += g * (at1 + 2.0 * (at2 + at3) + at4)
        done = done_next
        if abs(worst(p, y, theta)) > p[TOUCH]:
            w[io[out + CONTACT]] = 1.0
            if s[TOUCHED_MS] < 0.0:
                s[TOUCHED_MS] = (tick + a2) * p[DT]
            if p[SHORTS] != 0.0:
                yy = y + p[Y_MISS]
                lever = (theta + p[T_MISS]) * p[ROTOR]
                if abs(yy + lever) > p[TOUCH]:
                    short = joined(short, RIGHT)
                if abs(yy - lever) > p[TOUCH]:
                    short = joined(short, LEFT)
    w[io[out + DISPLACEMENT]] = settled(x)
    w[io[out + VELOCITY]] = settled(vx)
    w[io[out + LATERAL]] = worst(p, y, theta)
    w[io[out + SHIFT]] = settled(y)
    w[io[out + SHIFT_VELOCITY]] = settled(vy)
    w[io[out + ROTATION]] = settled(1e3 * theta)
    w[io[out + ROTATION_VELOCITY]] = settled(1e3 * omega)
    w[io[out + SHORT]] = short


class Planar(Shuttle):
    r"""Rigid shuttle in the plane: along x, sideways and in rotation, with pull-in, contact and short circuit.

    .. math:: m\ddot x=F_{e,x}-\partial U/\partial x-\beta\dot x,\quad
        m\ddot y=F_{e,y}-\partial U/\partial y-c_y\dot y,\quad
        J\ddot\theta=M_e-\partial U/\partial\theta-c_\theta\dot\theta

    Electrostatic forces are the derivatives of the co-energy along the finger overlap, elastic ones those of an energy
    fitted to a frame of beams. Classical Runge-Kutta, finer while fingers are far off centre. Fingers that touch
    short their comb, and stay short until the board is reset.
    """

    title = "Planar plant"
    inputs = (
        *Shuttle.inputs,
        Port("acceleration_side", "um/ms^2", "acceleration of the frame along y", source="effects.acceleration_side"),
        Port("cubic", "uN/um^3", "added cubic stiffness", source="effects.cubic"),
        Port("lateral_scale", "1", "stiffness along y over nominal", source="effects.lateral_scale"),
        Port("lateral_reach", "1", "reach of the stiffness along y over nominal", source="effects.lateral_reach"),
        Port("rotation_scale", "1", "stiffness against rotation over nominal", source="effects.rotation_scale"),
        Port("rotation_reach", "1", "reach of the same over nominal", source="effects.rotation_reach"),
        Port("sideways", "1/um", "added sideways shift per squared travel", source="effects.sideways"),
        Port("turn", "rad/um", "added rotation per travel", source="effects.turn"),
        Port("turn_cubic", "rad/um^3", "added rotation per cubed travel", source="effects.turn_cubic"),
    )
    equations = (
        Equation(
            "co-energy",
            r"W=\tfrac12V_1^2C_1+\tfrac12V_2^2C_2,\quad C_1=n\varepsilon_0t\int_{X_s}^{X_r+x}"
            r"\left[\tfrac1{g-\eta}+\tfrac1{g+\eta}\right]d\xi,\quad \eta=y+\theta\xi",
            "1.3.2 with fingers off centre",
        ),
        Equation(
            "elasticity",
            r"U=\tfrac12k_1x^2+\tfrac14k_3x^4+\tfrac12k_y(x)(y-y_2x^2)^2"
            r"+\tfrac12k_\theta(x)(\theta-\theta_1x-\theta_3x^3)^2",
        ),
        Equation("squeeze film of an arm", r"c=\tfrac12c_0\left[(1-\eta/g)^{-3}+(1+\eta/g)^{-3}\right]"),
        Equation(
            "pull-in by the bias alone",
            r"V_{b}=\sqrt{\frac{k_\theta g^3}{4n\varepsilon_0t\,(X_r^3-X_s^3)/3}}",
            "3.2.2",
            printed=r"\text{unstable beyond two thirds of the gap}",
            why="a third of the gap holds for a plate with one electrode; a finger between two of them loses "
            "stability at a voltage, with no travel at all, and with asymmetry folds at 0.10 to 0.18 of the gap",
        ),
    )

    class Params(PlaneParams):
        """Lateral mechanics; the defaults are those of the device LCR-350, x comes from the device."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array(cls.shared(params, context) + packed(params, context), dtype=np.float64)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Return room for the suspension and forces of a sample, and the time of the first contact."""
        start = np.zeros(17)
        start[TOUCHED_MS] = -1.0
        return start

    step = planar_step
