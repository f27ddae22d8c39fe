"""Many-input adaptive control: both axes follow sines, with estimates multiplied by the measured motion."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.two_axis import two_axis
from core.control.two_axis_adaptation import (
    EstimatePorts,
    Estimates,
    PackedLaw,
    adapt,
    asked,
    fill_law,
    push,
    write,
)
from core.units import hz_of_rad_ms


class MimoAdaptive(Block):
    r"""The controller of one input carried over to two (6.2): it cancels the estimated plant and puts a model in place.

    .. math:: \tau=(\hat K-K_m)q+\hat D\dot q+2\hat\Omega S\dot q-\gamma(\dot q-\dot q_m),\quad
        \dot{\hat K}=-g_K\,\mathrm{sym}(\dot e\,q^T),\;\dot{\hat D}=-g_D\,\mathrm{sym}(\dot e\,\dot q^T),\;
        \dot{\hat\Omega}=-2g_\Omega\,\dot e^TS\dot q

    with :math:`e=q-q_m` and :math:`K_m=\mathrm{diag}(\omega_1^2,\omega_2^2)`. With
    :math:`V=\tfrac12|\dot e|^2+\tfrac12 e^TK_me+\dots` its derivative is :math:`-\gamma|\dot e|^2`. The motion asked
    for has two frequencies; with one it is not persistently exciting, and the rate is not trusted. The text proposes
    the extension and derives nothing. The gains are for a device that swings with about 1 um, at 50 samples a radian;
    times are in 1/w0 of x.
    """

    title = "Many-input adaptive control"
    place = 20
    axes = ("x", "y")
    slot = "sense"
    equations = (
        Equation(
            "law",
            r"\tau=(\hat K-K_m)q+\hat D\dot q+2\hat\Omega S\dot q-\gamma(\dot q-\dot q_m)",
            "6.2",
            printed=r"\text{a multiple input multiple output expansion is more practical}",
            why="the text gives no law; this is the one that its single-input controller becomes",
        ),
        Equation(
            "adaptation",
            r"\dot{\hat K}=-g_K\,\mathrm{sym}(\dot e\,q^T),\;\dot{\hat D}=-g_D\,\mathrm{sym}(\dot e\,\dot q^T),\;"
            r"\dot{\hat\Omega}=-2g_\Omega\,\dot e^TS\dot q",
        ),
    )
    structure = (
        Stage("Error", "x_measured y_measured", "error_x error_y"),
        Stage(
            "Adaptation",
            "x_measured y_measured x_velocity y_velocity",
            "kxx kxy kyy dxx dxy dyy rate trusted unexciting",
            ("adaptation",),
        ),
        Stage("Law", "kxx kxy kyy dxx dxy dyy rate x_measured y_measured x_velocity y_velocity", "x y", ("law",)),
    )
    weaknesses = (
        "The laws multiply by the measured motion, so noise of the sensor biases the damping.",
        "One mass for both axes is assumed.",
    )

    class Params(BlockParams):
        """The motion asked for and the gains; times in 1/w0 of x."""

        amplitude_x_um: float = parameter(1.0, "amplitude along x", "um", gt=0, le=100)
        amplitude_y_um: float = parameter(1.0, "amplitude along y", "um", gt=0, le=100)
        frequency_x_hz: float | None = parameter(
            None, "frequency along x; that of the axis unless given", "Hz", gt=0, le=1e6
        )
        frequency_y_hz: float | None = parameter(
            None, "frequency along y; 1.3 of that along x unless given", "Hz", gt=0, le=1e6
        )
        velocity_gain: float = parameter(1.0, "gain gamma of the velocity error", "w0", ge=0, le=1e4)
        stiffness_gain: float = parameter(1.0, "gain g_K", "w0^2/um^2", ge=0, le=1e6)
        cross_gain: float = parameter(0.1, "gain g_D, of the damping", "1/um^2", ge=0, le=1e6)
        rate_gain: float = parameter(0.02, "gain g_O", "1/um^2", ge=0, le=1e6)
        advance: bool = parameter(False, "take the motion half a sample later, by which a held force is late")

    class Packed(PackedLaw):
        """The law."""

    class State(Estimates):
        """The estimates."""

    class Ports(EstimatePorts):
        """Forces and estimates."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the motion asked for and the gains."""
        device = two_axis(context)
        p = cls.Packed.blank()
        hz = hz_of_rad_ms(device.natural_frequency)
        fill_law(p, params, context, hz, 1.3 * hz, 1.0 / device.natural_frequency)
        p.gains.rate *= 2.0  # its law has 2 g_O
        return p

    @staticmethod
    def step(p: Packed, s: State, x: MimoAdaptive.Ports) -> None:
        """Put the model in the place of the plant, and adapt while it drives."""
        unit = p.asked.unit_ms
        q1, q2, w1, w2 = asked(p.asked, x.time_ms)
        x.error_x = x.x_measured - q1
        x.error_y = x.y_measured - q2
        v1 = unit * x.x_velocity
        v2 = unit * x.y_velocity
        e1 = v1 - w1
        e2 = v2 - w2
        if x.engaged != 0.0:
            adapt(p.gains, s, e1, e2, x.x_measured, x.y_measured, v1, v2)
        # where the motion will be when the held force has its effect
        q1 = x.x_measured + p.asked.ahead_ms * x.x_velocity
        q2 = x.y_measured + p.asked.ahead_ms * x.y_velocity
        along, across = push(s, q1, q2, v1, v2)
        x.x = p.force_x * (along - p.asked.omega_x * p.asked.omega_x * q1 - p.gains.velocity * e1)
        x.y = p.force_y * (across - p.asked.omega_y * p.asked.omega_y * q2 - p.gains.velocity * e2)
        write(p.asked, s, x, p.mass)
