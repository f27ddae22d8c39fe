"""Linear plant, exact between samples."""

from __future__ import annotations

from core.block import Equation
from core.device.oscillator import transition
from core.kernel import flush_tiny
from core.plant.shuttle import (
    Shuttle,
    ShuttleParams,
    at_rest_sideways,
    coefficients,
    comb_force,
    drive_noise,
    dry_friction,
    joined,
    thermal_force,
)
from core.record import Record


class Linear(Shuttle):
    r"""Mass, damper and spring, :math:`m\ddot x+\beta\dot x+kx=F_e` (1.3.1, with :math:`k=2k_s`).

    Exact for a held drive. A continuous drive is a parabola over each sample, exact to
    :math:`O((\omega\,dt)^4)`. Holding a 2 kHz sine at 100 kHz instead is off by 6.6 % of the peak, which is
    right for a DAC and wrong for a generator. Friction stops the shuttle in the sample in which it turns.
    """

    title = "Linear plant"
    equations = (
        Equation("motion", r"m\ddot x+\beta\dot x+kx=F_e", "1.3.1; k = 2 k_s"),
        Equation(
            "comb force",
            r"F_e=\tfrac12\frac{dC}{dx}\left[(V_{b1}-v)^2-(V_{b2}-v)^2\right]=-4n\varepsilon_0\frac{t}{g}V_b\,v",
            "1.3.2, 5.2.1",
            printed=r"\text{5.2.1: two identical DC voltages; } t = \text{length of a finger}",
            why="identical voltages on both stators cancel; the stators carry +V_b and -V_b, and t is the "
            "structural thickness",
        ),
        Equation("between samples", r"x_{i+1}=\Phi(x_i-x_p(0))+x_p(h),\quad \Phi=e^{Ah}"),
    )

    class Params(ShuttleParams):
        """Parameters of the linear plant."""

    class State(Record):
        """Mass, damping, stiffness and interval of the transition kept, and the transition."""

        mass: float
        damping: float
        stiffness: float
        dt_ms: float
        phi11: float
        phi12: float
        phi21: float
        phi22: float

    @staticmethod
    def step(p: Shuttle.Packed, s: State, x: Shuttle.Ports) -> None:
        """Advance over the interval that ends now; the first tick only sets the start."""
        short = joined(x.short, x.shorted)
        at_rest_sideways(x, short)
        if x.tick == 0.0:
            x.displacement = p.initial_displacement_um
            x.velocity = p.initial_velocity_um_ms
            return
        m, b, k = coefficients(p, x)
        if m != s.mass or b != s.damping or k != s.stiffness or p.dt_ms != s.dt_ms:
            s.mass, s.damping, s.stiffness, s.dt_ms = m, b, k, p.dt_ms
            s.phi11, s.phi12, s.phi21, s.phi22 = transition(m, b, k, p.dt_ms)
        tick = x.tick - 1.0
        noise = drive_noise(p, tick)
        gain = x.drive_gain
        u0 = gain * x.voltage + x.drive_offset
        f0 = comb_force(p, u0 + noise, short) + thermal_force(p, b, tick) - m * x.acceleration
        q = x.displacement
        v = x.velocity
        rubbing = x.friction > 0.0
        if rubbing:
            net = f0 - k * q
            if v == 0.0 and abs(net) <= x.friction:
                return
            f0 += dry_friction(x.friction, v, net)
        if x.middle == x.voltage and x.end == x.voltage:
            # a held drive: the particular solution is the static displacement
            rest = f0 / k
            x.displacement = flush_tiny(s.phi11 * (q - rest) + s.phi12 * v + rest)
            x.velocity = flush_tiny(s.phi21 * (q - rest) + s.phi22 * v)
        else:
            # an analogue drive: a parabola through the start, middle and end of the interval
            h = p.dt_ms
            at_start = comb_force(p, u0, short)
            d1 = comb_force(p, gain * x.middle + x.drive_offset, short) - at_start
            d2 = comb_force(p, gain * x.end + x.drive_offset, short) - at_start
            f1 = (4.0 * d1 - d2) / h
            f2 = (2.0 * d2 - 4.0 * d1) / (h * h)
            c2 = f2 / k
            c1 = (f1 - 2.0 * b * c2) / k
            c0 = (f0 - b * c1 - 2.0 * m * c2) / k
            x.displacement = s.phi11 * (q - c0) + s.phi12 * (v - c1) + c0 + c1 * h + c2 * h * h
            x.velocity = s.phi21 * (q - c0) + s.phi22 * (v - c1) + c1 + 2.0 * c2 * h
        if rubbing and v * x.velocity < 0.0:
            # friction brings the shuttle to rest where it would turn
            x.velocity = 0.0
