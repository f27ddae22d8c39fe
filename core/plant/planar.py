"""Plant in the plane: along x, sideways and in rotation, with pull-in, contact and short circuit."""

from __future__ import annotations

from core.block import Equation
from core.kernel import flush_tiny
from core.noise import normal
from core.plant.body import acceleration, noise_of, prepare, worst
from core.plant.plane import Plane, PlaneParams
from core.plant.shuttle import (
    LEFT,
    RIGHT,
    comb_voltage,
    comb_voltage_parabola,
    drive_noise,
    dry_friction,
    joined,
    thermal_force,
)


class Planar(Plane):
    r"""Rigid shuttle in the plane: along x, sideways and in rotation, with pull-in, contact and short circuit.

    .. math:: m\ddot x=F_{e,x}-\partial U/\partial x-\beta\dot x,\quad
        m\ddot y=F_{e,y}-\partial U/\partial y-c_y\dot y,\quad
        J\ddot\theta=M_e-\partial U/\partial\theta-c_\theta\dot\theta

    Electrostatic forces are the derivatives of the co-energy along the finger overlap, elastic forces the derivatives
    of an energy fitted to a frame of beams. Classical Runge-Kutta, finer while fingers are far off centre. Fingers that
    touch short their comb, and stay short until the board is reset.
    """

    title = "Planar plant"
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
        Equation(
            "squeeze film of an arm",
            r"c=\tfrac12c_0\left[(1-\eta/g)^{-3}+(1+\eta/g)^{-3}\right],\quad "
            r"c_0=\frac{4n\mu L_0t^3/g^3}{1+9.638K_n^{1.159}}",
            "Veijola, recalled",
        ),
        Equation(
            "pull-in by the bias alone",
            r"V_{b}=\sqrt{\frac{k_\theta g^3}{4n\varepsilon_0t\,(X_r^3-X_s^3)/3}}",
            "3.2.2",
            printed=r"\text{unstable beyond two thirds of the gap}",
            why="a third of the gap holds for a plate with one electrode; a finger between two of them loses "
            "stability at a voltage, with no travel at all, and with asymmetry folds at 0.10 to 0.18 of the gap",
        ),
    )

    weaknesses = (
        "With a suspension that is damaged on one side, what happens across the drive is rough at small strokes: the "
        "sideways shift has no part in proportion to the travel. Beside a frame of beams at large displacements, at "
        "+1 um of travel, a broken truss end shifts the shuttle by +0.1 instead of -0.6 nm and its worst corner by 2.1 "
        "instead of 3.1 nm (24 instead of 49 nm at +8 um), and a point adhesion shifts it by 1.1 instead of 0.6 nm. Up "
        "to 1 um the force along x is right to 0.5 %, and with a whole truss lost all of it is.",
        "The sideways mode is at 153 kHz: with step_us of 0.5 it keeps 0.94 of its Brownian motion, with 1 it keeps "
        "0.46; with the usual 0.25 all of it.",
    )

    class Params(PlaneParams):
        """Mechanics across the drive; missing values follow from the drawing of the device."""

    @staticmethod
    def step(p: Plane.Packed, s: Plane.State, x: Plane.Ports) -> None:
        """Advance over the interval that ends now by Runge-Kutta substeps."""
        short = joined(x.short, x.shorted)
        x.contact = 0.0
        qx = x.displacement
        qy = x.shift
        theta = 1e-3 * x.rotation
        vx = x.velocity
        vy = x.shift_velocity
        omega = 1e-3 * x.rotation_velocity
        if x.tick == 0.0:
            qx, vx, qy, vy, theta, omega = p.initial_displacement_um, p.initial_velocity_um_ms, 0.0, 0.0, 0.0, 0.0
        prepare(p, s, x)
        m = 1.0 / s.per_mass
        tick = x.tick - 1.0
        rest_x = -m * x.acceleration
        rest_y = -m * x.acceleration_side
        l11, l21, l22 = 0.0, 0.0, 0.0
        if p.thermal_coarse > 0.0 and tick >= 0.0:
            rest_x += thermal_force(p, s.damping, tick)
            l11, l21, l22 = noise_of(p, s, qy, theta)
        u0, rise, bend = comb_voltage_parabola(x)
        if tick >= 0.0:
            u0 += drive_noise(p, tick)
        rubbing = x.friction
        fine = int(p.fine_steps)
        total = int(p.coarse_steps) * fine if tick >= 0.0 else 0
        done = 0
        while done < total:
            # one coarse substep, or a fine one of its parts while fingers are far off centre
            stride = fine if done % fine == 0 and abs(worst(p, qy, theta)) < p.near_um else 1
            h = p.dt_ms * stride / total
            a0 = done / total
            a1 = (done + 0.5 * stride) / total
            done_next = done + stride
            a2 = done_next / total
            s.force_x = rest_x
            s.force_y = rest_y
            kick = 0.0
            if p.thermal_coarse > 0.0:
                scale = p.thermal_coarse if stride == fine else p.thermal_fine
                count = tick * total + done
                n1 = scale * normal(p.side_key, count)
                s.force_y = rest_y + l11 * n1
                kick = (l21 * n1 + l22 * scale * normal(p.turn_key, count)) * p.per_inertia
            u = u0 + a0 * (rise + a0 * bend)
            r0 = comb_voltage(p.first_v - u, short, RIGHT)
            l0 = comb_voltage(p.second_v - u, short, LEFT)
            u = u0 + a1 * (rise + a1 * bend)
            r1 = comb_voltage(p.first_v - u, short, RIGHT)
            l1 = comb_voltage(p.second_v - u, short, LEFT)
            u = u0 + a2 * (rise + a2 * bend)
            r2 = comb_voltage(p.first_v - u, short, RIGHT)
            l2 = comb_voltage(p.second_v - u, short, LEFT)
            r0, l0, r1, l1, r2, l2 = r0 * r0, l0 * l0, r1 * r1, l1 * l1, r2 * r2, l2 * l2
            held = False
            if rubbing > 0.0:
                net = m * acceleration(p, s, qx, qy, theta, 0.0, vy, omega, r0, l0)[0]
                held = vx == 0.0 and abs(net) <= rubbing
                s.force_x += dry_friction(rubbing, vx, net)
            g = 0.5 * h
            ax1, ay1, at1 = acceleration(p, s, qx, qy, theta, vx, vy, omega, r0, l0)
            at1 += kick
            vx2, vy2, om2 = vx + g * ax1, vy + g * ay1, omega + g * at1
            ax2, ay2, at2 = acceleration(p, s, qx + g * vx, qy + g * vy, theta + g * omega, vx2, vy2, om2, r1, l1)
            at2 += kick
            vx3, vy3, om3 = vx + g * ax2, vy + g * ay2, omega + g * at2
            ax3, ay3, at3 = acceleration(p, s, qx + g * vx2, qy + g * vy2, theta + g * om2, vx3, vy3, om3, r1, l1)
            at3 += kick
            vx4, vy4, om4 = vx + h * ax3, vy + h * ay3, omega + h * at3
            ax4, ay4, at4 = acceleration(p, s, qx + h * vx3, qy + h * vy3, theta + h * om3, vx4, vy4, om4, r2, l2)
            at4 += kick
            g = h / 6.0
            before = vx
            if not held:
                qx += g * (vx + 2.0 * (vx2 + vx3) + vx4)
                vx += g * (ax1 + 2.0 * (ax2 + ax3) + ax4)
                if rubbing > 0.0 and before * vx < 0.0:
                    vx = 0.0  # friction brings the shuttle to rest where it would turn
            qy += g * (vy + 2.0 * (vy2 + vy3) + vy4)
            theta += g * (omega + 2.0 * (om2 + om3) + om4)
            vy += g * (ay1 + 2.0 * (ay2 + ay3) + ay4)
            omega += g * (at1 + 2.0 * (at2 + at3) + at4)
            done = done_next
            if abs(worst(p, qy, theta)) > p.touch_um:
                x.contact = 1.0
                if s.touched_ms < 0.0:
                    s.touched_ms = (tick + a2) * p.dt_ms
                if p.short_on_contact != 0.0:
                    yy = qy + p.misalignment_um
                    lever = (theta + p.misalignment_rad) * p.rotor_tip
                    if abs(yy + lever) > p.touch_um:
                        short = joined(short, RIGHT)
                    if abs(yy - lever) > p.touch_um:
                        short = joined(short, LEFT)
        x.displacement = flush_tiny(qx)
        x.velocity = flush_tiny(vx)
        x.lateral = worst(p, qy, theta)
        x.shift = flush_tiny(qy)
        x.shift_velocity = flush_tiny(vy)
        x.rotation = flush_tiny(1e3 * theta)
        x.rotation_velocity = flush_tiny(1e3 * omega)
        x.short = short
