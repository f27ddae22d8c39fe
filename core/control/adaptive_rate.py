"""Adaptive control with an estimate of the rate: both axes follow sines; their forces show all parameters."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.rate_bound import fill_basis
from core.control.two_axis import two_axis
from core.control.two_axis_adaptation import adapt, asked, fill_law, held, push, velocity_errors, write
from core.control.two_axis_estimates import AxisEstimates, PackedLaw, TwoAxisEstimatePorts
from core.units import hz_of_rad_ms

USUAL_SHARE = 0.2213
"""Frequency of the desired motion along x over the frequency of the axis, unless given: well below the resonances."""
USUAL_RATIO = 1.2247
"""Frequency along y over the frequency along x, unless given: the ratio of the axes of set A. Equal axes would hardly
beat."""
USUAL_FORCE_UN, USUAL_UM, USUAL_SIZES = 400.0, 1.0, 1.2
"""Most elastic force of the usual amplitude along x, this amplitude, and that along y over it."""
PACE = 0.4
"""Most rad in a sample at which the usual gains learn."""
VELOCITY, STIFFNESS = 1.061, 1.125
"""Usual gain of the velocity error over the pace, and of the stiffness over its square; set A: 20/ms, 400/ms^2."""

ADAPTATION = Equation(
    "adaptation",
    r"\dot{\hat K}=-g_K\,\mathrm{sym}(\dot e\,q_m^T),\quad\dot{\hat D}=-g_D\,\mathrm{sym}(\dot e\,\dot q_m^T),\quad"
    r"\dot{\hat\Omega}=-g_\Omega\,\dot e^TS\dot q_m",
    "Park and Horowitz 2003",
)
SAMPLE = Equation(
    "sample",
    r"q_m\to\frac{\omega h/2}{\sin(\omega h/2)}\,q_m(t+\tfrac12h),\quad\dot e\to\dot e+\tfrac1{12}h^2\dot\tau,\quad"
    r"\dot{\hat n}=-\tfrac12g_K\,\dot e^TSq",
)


class AdaptiveRate(Block):
    r"""Follows two sines of different frequencies with estimates of stiffness, damping and rate.

    .. math:: \tau=(\hat K+\hat nS-K_m)q_m+\hat D\dot q_m+2\hat\Omega S\dot q_m-\gamma\dot e,\quad e=q-q_m,\quad
        q_m=(A_1\sin\omega_1t,\;A_2\sin\omega_2t),\quad K_m=\mathrm{diag}(\omega_1^2,\omega_2^2)

    The laws multiply by the desired motion, not by the measured motion, so that noise does not bias them. Velocities
    are measured. With :math:`\omega_1=\omega_2` the motion is not persistently exciting: it is followed all the same,
    but rate and damping are indistinguishable, and the estimate is not trusted. Leland (2006) holds one axis to a sine
    and the other at zero: this is ``drive_tracking`` with ``sense_axis_sync`` at zero.

    A held force is late by half a sample and weaker than its sine, and makes the measured velocity ripple; the law
    compensates all three, and :math:`\hat n` takes the remaining part in step with the motion. The bound of the rate
    contains this remaining part, the rest of the learning, and the swing of the estimate; the estimate is trusted while
    the bound is at most a quarter of it.

    The usual gains are proportional to the frequency of x, :math:`\omega_x`, or to 0.4 a sample where that is slower:
    a velocity error is damped at :math:`1.061\,\omega_x`, and the estimates follow ten times slower. Ten times the gain
    of the velocity error diverges on set A at 100 kHz, and so do a hundred times the gain of the stiffness and four
    hundred times the gains of damping and rate; the bench then stops with a trip.
    """

    title = "Adaptive control with rate estimate"
    place = 22
    axes = ("x", "y")
    slot = "sense"
    equations = (
        Equation(
            "law", r"\tau=(\hat K-K_m)q_m+\hat D\dot q_m+2\hat\Omega S\dot q_m-\gamma\dot e", "Park and Horowitz 2003"
        ),
        ADAPTATION,
        SAMPLE,
    )
    structure = (
        Stage("Error", "x_measured y_measured", "error_x error_y"),
        Stage(
            "Adaptation",
            "x_velocity y_velocity",
            "kxx kxy kyy skew dxx dxy dyy rate bound trusted unexciting",
            ("adaptation", "sample"),
        ),
        Stage("Law", "kxx kxy kyy skew dxx dxy dyy rate x_velocity y_velocity", "x y", ("law", "sample")),
    )
    weaknesses = (
        "Held at 100 kHz, modes of 18 kHz leave 0.14 deg/s and 0.14 % of the rate on set B; the bound says so, and "
        "0.5 and 1 deg/s are not trusted there. With the thermal noise of set B none below 5 deg/s is.",
        "References on the resonances of set A cost a quarter of the force of slow ones; its cross stiffness takes the "
        "rest.",
        "An error of the masses or of the drive is one of the scale, and neither the rate nor its bound tells it.",
    )

    class Params(BlockParams):
        """The desired motion and the gains; times in ms."""

        amplitude_x_um: float | None = parameter(
            None, "amplitude along x; 1 um, or what 400 uN bend the spring by, unless given", "um", gt=0, le=100
        )
        amplitude_y_um: float | None = parameter(
            None, "amplitude along y; 1.2 of that along x unless given", "um", gt=0, le=100
        )
        frequency_x_hz: float | None = parameter(
            None, "frequency along x; 0.2213 of the axis frequency unless given", "Hz", gt=0, le=1e6
        )
        frequency_y_hz: float | None = parameter(
            None, "frequency along y; 1.2247 of that along x unless given", "Hz", gt=0, le=1e6
        )
        velocity_gain: float | None = parameter(
            None, "gain gamma of the velocity error; 1.061 of the pace unless given", "1/ms", ge=0, le=1e4
        )
        stiffness_gain: float | None = parameter(
            None, "gain g_K; 1.125 of the squared pace unless given", "1/(um^2 ms^2)", ge=0, le=1e6
        )
        cross_gain: float = parameter(2.0, "gain g_D, of the damping", "1/um^2", ge=0, le=1e6)
        rate_gain: float = parameter(1.0, "gain g_O", "1/um^2", ge=0, le=1e6)
        bandwidth_hz: float = parameter(30.0, "bandwidth of the low-pass behind the rate", "Hz", ge=10, le=1e5)

    class Packed(PackedLaw):
        """The law."""

    class State(AxisEstimates):
        """The estimates."""

    class Ports(TwoAxisEstimatePorts):
        """Forces and estimates."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the desired motion and the gains."""
        p = cls.Packed.blank()
        device = two_axis(context)
        natural = device.natural_frequency
        pace = min(natural, PACE / context.dt_ms)
        velocity, stiffness = params.velocity_gain, params.stiffness_gain
        size = params.amplitude_x_um or min(USUAL_UM, USUAL_FORCE_UN / device.stiffness)
        along_x = params.frequency_x_hz or USUAL_SHARE * hz_of_rad_ms(natural)
        fill_law(
            p,
            params,
            context,
            (size, params.amplitude_y_um or USUAL_SIZES * size),
            (along_x, params.frequency_y_hz or USUAL_RATIO * along_x),
            1.0,
            VELOCITY * pace if velocity is None else velocity,
            STIFFNESS * pace * pace if stiffness is None else stiffness,
        )
        fill_basis(p.basis, p.asked, p.gains, context.dt_ms, cancels=False)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: AdaptiveRate.Ports) -> None:
        """Follow the desired motion, and adapt while it drives: another motion carries no information about it."""
        q1, q2, v1, v2 = asked(p.asked, x.time_ms)
        x.error_x = x.x_measured - q1
        x.error_y = x.y_measured - q2 / p.stretch
        e1, e2 = velocity_errors(p, s, x, q1, q2, v1, v2)
        if x.engaged != 0.0:
            adapt(p.gains, s, e1, e2, q1, q2, v1, v2)
        q1, q2, v1, v2 = held(p.asked, x.time_ms)
        along, across = push(s, q1, q2, v1, v2)
        x.x = p.force_x * (along - p.asked.omega_x * p.asked.omega_x * q1 - p.gains.velocity * e1)
        x.y = p.force_y * (across - p.asked.omega_y * p.asked.omega_y * q2 - p.gains.velocity * e2)
        write(p, s, x)
