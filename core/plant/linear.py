"""Linear plant, exact between samples."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, settled
from core.device.oscillator import transition
from core.plant.shuttle import (
    ACCELERATION,
    DISPLACEMENT,
    DRIVE_GAIN,
    DRIVE_OFFSET,
    DT,
    END,
    FIRST_OWN_INPUT,
    FRICTION,
    MIDDLE,
    SHORT,
    SHORTED,
    V0,
    VELOCITY,
    VOLTAGE,
    X0,
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

X_OUT, V_OUT, SHORT_OUT = FIRST_OWN_INPUT + DISPLACEMENT, FIRST_OWN_INPUT + VELOCITY, FIRST_OWN_INPUT + SHORT


def linear_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance over the interval that ends now; the first tick only sets the start."""
    short = joined(w[io[SHORT_OUT]], w[io[SHORTED]])
    at_rest_sideways(w, io, FIRST_OWN_INPUT, short)
    if w[TICK] == 0.0:
        w[io[X_OUT]] = p[X0]
        w[io[V_OUT]] = p[V0]
        return
    m, b, k = coefficients(p, w, io)
    if m != s[0] or b != s[1] or k != s[2] or p[DT] != s[3]:
        s[0], s[1], s[2], s[3] = m, b, k, p[DT]
        s[4], s[5], s[6], s[7] = transition(m, b, k, p[DT])
    tick = w[TICK] - 1.0
    noise = drive_noise(p, tick)
    gain = w[io[DRIVE_GAIN]]
    u0 = gain * w[io[VOLTAGE]] + w[io[DRIVE_OFFSET]]
    f0 = comb_force(p, u0 + noise, short) + thermal_force(p, b, tick) - m * w[io[ACCELERATION]]
    x = w[io[X_OUT]]
    v = w[io[V_OUT]]
    rubbing = w[io[FRICTION]] > 0.0
    if rubbing:
        net = f0 - k * x
        if v == 0.0 and abs(net) <= w[io[FRICTION]]:
            return
        f0 += dry_friction(w[io[FRICTION]], v, net)
    if w[io[MIDDLE]] == w[io[VOLTAGE]] and w[io[END]] == w[io[VOLTAGE]]:
        # a held drive: the particular solution is the static displacement
        rest = f0 / k
        w[io[X_OUT]] = settled(s[4] * (x - rest) + s[5] * v + rest)
        w[io[V_OUT]] = settled(s[6] * (x - rest) + s[7] * v)
    else:
        # an analogue drive: a parabola through the start, middle and end of the interval
        h = p[DT]
        at_start = comb_force(p, u0, short)
        d1 = comb_force(p, gain * w[io[MIDDLE]] + w[io[DRIVE_OFFSET]], short) - at_start
        d2 = comb_force(p, gain * w[io[END]] + w[io[DRIVE_OFFSET]], short) - at_start
        f1 = (4.0 * d1 - d2) / h
        f2 = (2.0 * d2 - 4.0 * d1) / (h * h)
        c2 = f2 / k
        c1 = (f1 - 2.0 * b * c2) / k
        c0 = (f0 - b * c1 - 2.0 * m * c2) / k
        w[io[X_OUT]] = s[4] * (x - c0) + s[5] * (v - c1) + c0 + c1 * h + c2 * h * h
        w[io[V_OUT]] = s[6] * (x - c0) + s[7] * (v - c1) + c1 + 2.0 * c2 * h
    if rubbing and v * w[io[V_OUT]] < 0.0:
        # friction brings the shuttle to rest where it would turn
        w[io[V_OUT]] = 0.0


class Linear(Shuttle):
    r"""Mass, damper and spring, :math:`m\ddot x+\beta\dot x+kx=F_e` (1.3.1, with :math:`k=2k_s`).

    Exact for a held drive. A continuous drive is a parabola over each sample, exact to
    :math:`O((\omega\,dt)^4)`; holding a 2 kHz sine at 100 kHz instead is off by 6.6 % of the peak, which is
    the truth about a DAC and wrong about a generator. Friction stops the shuttle in the sample in which it turns.
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

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array(cls.shared(params, context), dtype=np.float64)

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Mass, damping, stiffness and interval of the transition kept, and the transition."""
        return np.zeros(8)

    step = linear_step
