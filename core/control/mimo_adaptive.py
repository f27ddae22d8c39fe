"""Many-input adaptive control: both axes follow sines, with estimates multiplied by the measured motion."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.adaptive_rate import SAMPLE
from core.control.rate_bound import fill_basis
from core.control.two_axis import two_axis
from core.control.two_axis_adaptation import adapt, asked, fill_law, held, push, velocity_errors, write
from core.control.two_axis_estimates import AxisEstimates, PackedLaw, TwoAxisEstimatePorts
from core.units import hz_of_rad_ms

SLOWEST = 0.2
"""Largest angle, rad, that the desired motion along x turns in a sample, unless its frequency is given, and the unit of
time."""
USUAL_RATIO = 1.3
"""Frequency along y over that along x, unless given."""


class MimoAdaptive(Block):
    r"""The controller of one input carried over to two (6.2): it cancels the estimated plant and puts a model in place.

    .. math:: \tau=(\hat K+\hat nS-K_m)q+\hat D\dot q+2\hat\Omega S\dot q-\gamma(\dot q-\dot q_m),\quad
        \dot{\hat K}=-g_K\,\mathrm{sym}(\dot e\,q^T),\;\dot{\hat D}=-g_D\,\mathrm{sym}(\dot e\,\dot q^T),\;
        \dot{\hat\Omega}=-2g_\Omega\,\dot e^TS\dot q

    with :math:`e=q-q_m` and :math:`K_m=\mathrm{diag}(\omega_1^2,\omega_2^2)`. With :math:`V=\tfrac12|\dot e|^2+\tfrac12
    e^TK_me+\dots` its derivative is :math:`-\gamma|\dot e|^2`. The desired motion has two frequencies; with one it is
    not persistently exciting, and the rate is not trusted. The text proposes the extension and derives nothing.

    A held force is late by half a sample and weaker than its sine, and makes the measured velocity ripple; the law
    compensates all three as ``adaptive_rate`` does, and extrapolates the deviation from the desired motion by half a
    sample. Times are in 1/w of x, :math:`\omega` being the frequency of x, or 0.2 rad a sample where that is slower;
    the gains are for a device that swings with about 1 um.
    """

    title = "Many-input adaptive control"
    place = 23
    axes = ("x", "y")
    slot = "sense"
    equations = (
        Equation(
            "law",
            r"\tau=(\hat K-K_m)q+\hat D\dot q+2\hat\Omega S\dot q-\gamma(\dot q-\dot q_m)",
            "6.2",
            printed=r"\text{a multiple input multiple output expansion is more practical}",
            why="the text gives no law; this law extends its single-input controller",
        ),
        Equation(
            "adaptation",
            r"\dot{\hat K}=-g_K\,\mathrm{sym}(\dot e\,q^T),\;\dot{\hat D}=-g_D\,\mathrm{sym}(\dot e\,\dot q^T),\;"
            r"\dot{\hat\Omega}=-2g_\Omega\,\dot e^TS\dot q",
        ),
        SAMPLE,
    )
    structure = (
        Stage("Error", "x_measured y_measured", "error_x error_y"),
        Stage(
            "Adaptation",
            "x_measured y_measured x_velocity y_velocity",
            "kxx kxy kyy skew dxx dxy dyy rate bound trusted unexciting",
            ("adaptation", "sample"),
        ),
        Stage(
            "Law",
            "kxx kxy kyy skew dxx dxy dyy rate x_measured y_measured x_velocity y_velocity",
            "x y",
            ("law", "sample"),
        ),
    )
    weaknesses = (
        "The laws multiply by the measured motion, so noise of the sensor biases the damping.",
        "On set B at 100 kHz the deviation half a sample on is not known well enough: the rate reads 10 deg/s low, the "
        "bound says 21, and rates below 84 deg/s are not trusted; at 1 MHz it is 0.001.",
        "An error of the masses or of the drive is one of the scale, and neither the rate nor its bound tells it.",
    )

    class Params(BlockParams):
        """The desired motion and the gains; times in 1/w0 of x, or in samples of 0.2 rad where that is slower."""

        amplitude_x_um: float = parameter(1.0, "amplitude along x", "um", gt=0, le=100)
        amplitude_y_um: float = parameter(1.0, "amplitude along y", "um", gt=0, le=100)
        frequency_x_hz: float | None = parameter(
            None, "frequency along x; the axis frequency, or 0.2 rad a sample, unless given", "Hz", gt=0, le=1e6
        )
        frequency_y_hz: float | None = parameter(
            None, "frequency along y; 1.3 of that along x unless given", "Hz", gt=0, le=1e6
        )
        velocity_gain: float = parameter(1.0, "gain gamma of the velocity error", "w0", ge=0, le=1e4)
        stiffness_gain: float = parameter(1.0, "gain g_K", "w0^2/um^2", ge=0, le=1e6)
        cross_gain: float = parameter(0.1, "gain g_D, of the damping", "1/um^2", ge=0, le=1e6)
        rate_gain: float = parameter(0.02, "gain g_O", "1/um^2", ge=0, le=1e6)
        bandwidth_hz: float = parameter(30.0, "bandwidth of the low-pass behind the rate", "Hz", ge=10, le=1e5)

    class Packed(PackedLaw):
        """The law."""

    class State(AxisEstimates):
        """The estimates, and the last deviation of both axes from the desired motion."""

        last_x: float
        last_y: float

    class Ports(TwoAxisEstimatePorts):
        """Forces and estimates."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the desired motion and the gains."""
        p = cls.Packed.blank()
        pace = min(two_axis(context).natural_frequency, SLOWEST / context.dt_ms)
        along_x = params.frequency_x_hz or hz_of_rad_ms(pace)
        hz = along_x, params.frequency_y_hz or USUAL_RATIO * along_x
        um = params.amplitude_x_um, params.amplitude_y_um
        fill_law(p, params, context, um, hz, 1.0 / pace, params.velocity_gain, params.stiffness_gain)
        p.gains.rate *= 2.0  # its law has 2 g_O
        fill_basis(p.basis, p.asked, p.gains, context.dt_ms, cancels=True)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: MimoAdaptive.Ports) -> None:
        """Put the model in the place of the plant, and adapt while it drives."""
        q1, q2, v1, v2 = asked(p.asked, x.time_ms)
        off_x = x.x_measured - q1
        off_y = p.stretch * x.y_measured - q2
        x.error_x = off_x
        x.error_y = off_y / p.stretch
        e1, e2 = velocity_errors(p, s, x, q1, q2, v1, v2)
        if x.engaged != 0.0:
            adapt(p.gains, s, e1, e2, q1 + off_x, q2 + off_y, v1 + e1, v2 + e2)
        # where the motion will be when the held force has its effect
        q1, q2, v1, v2 = held(p.asked, x.time_ms)
        q1 += 1.5 * off_x - 0.5 * s.last_x
        q2 += 1.5 * off_y - 0.5 * s.last_y
        s.last_x, s.last_y = off_x, off_y
        along, across = push(s, q1, q2, v1 + e1, v2 + e2)
        x.x = p.force_x * (along - p.asked.omega_x * p.asked.omega_x * q1 - p.gains.velocity * e1)
        x.y = p.force_y * (across - p.asked.omega_y * p.asked.omega_y * q2 - p.gains.velocity * e2)
        write(p, s, x)
