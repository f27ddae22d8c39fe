"""Adaptive control with an estimate of the rate: both axes follow sines, and what that takes tells all parameters."""

from __future__ import annotations

import math
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

USUAL_SHARE = 0.2213
"""Frequency of the motion asked for over that of each axis, unless given: well below the resonances."""

ADAPTATION = Equation(
    "adaptation",
    r"\dot{\hat K}=-g_K\,\mathrm{sym}(\dot e\,q_m^T),\quad\dot{\hat D}=-g_D\,\mathrm{sym}(\dot e\,\dot q_m^T),\quad"
    r"\dot{\hat\Omega}=-g_\Omega\,\dot e^TS\dot q_m",
    "Park and Horowitz 2003",
)


class AdaptiveRate(Block):
    r"""Follows two sines of different frequencies with estimates of stiffness, damping and rate.

    .. math:: \tau=(\hat K-K_m)q_m+\hat D\dot q_m+2\hat\Omega S\dot q_m-\gamma\dot e,\quad e=q-q_m,\quad
        q_m=(A_1\sin\omega_1t,\;A_2\sin\omega_2t),\quad K_m=\mathrm{diag}(\omega_1^2,\omega_2^2)

    The laws multiply by the motion asked for, not by the measured one, so that noise does not bias them. Velocities
    are measured. With :math:`\omega_1=\omega_2` the motion is not persistently exciting: it is followed all the same,
    but the rate is not told from the damping, and the estimate is not trusted. Leland (2006) holds one axis to a sine
    and the other at rest: that is ``drive_tracking`` with ``sense_axis_sync`` at rest.

    The gains are for the set A of the literature at 100 kHz, with lengths in um and times in ms: a velocity error is
    damped in 1/20 ms, and the estimates follow ten times slower. Ten times the gain of the velocity error diverges
    there, and so do a hundred times that of the stiffness and four hundred times those of damping and rate; the bench
    then stops with a trip.
    """

    title = "Adaptive control with rate estimate"
    place = 19
    axes = ("x", "y")
    slot = "sense"
    equations = (
        Equation(
            "law", r"\tau=(\hat K-K_m)q_m+\hat D\dot q_m+2\hat\Omega S\dot q_m-\gamma\dot e", "Park and Horowitz 2003"
        ),
        ADAPTATION,
    )
    structure = (
        Stage("Error", "x_measured y_measured", "error_x error_y"),
        Stage(
            "Adaptation", "x_velocity y_velocity", "kxx kxy kyy dxx dxy dyy rate trusted unexciting", ("adaptation",)
        ),
        Stage("Law", "kxx kxy kyy dxx dxy dyy rate x_velocity y_velocity", "x y", ("law",)),
    )
    weaknesses = (
        "References on the resonances cost a quarter of the force of slow ones on set A, whose cross stiffness takes "
        "the rest, but the rate is then 3 to 5 % high at 100 kHz and swings for as long as it runs.",
        "One mass for both axes is assumed.",
    )

    class Params(BlockParams):
        """The motion asked for and the gains; times in ms."""

        amplitude_x_um: float = parameter(1.0, "amplitude along x", "um", gt=0, le=100)
        amplitude_y_um: float = parameter(1.2, "amplitude along y", "um", gt=0, le=100)
        frequency_x_hz: float | None = parameter(
            None, "frequency along x; 0.2213 of that of the axis unless given", "Hz", gt=0, le=1e6
        )
        frequency_y_hz: float | None = parameter(
            None, "frequency along y; 0.2213 of that of the axis unless given", "Hz", gt=0, le=1e6
        )
        velocity_gain: float = parameter(20.0, "gain gamma of the velocity error", "1/ms", ge=0, le=1e4)
        stiffness_gain: float = parameter(400.0, "gain g_K", "1/(um^2 ms^2)", ge=0, le=1e6)
        cross_gain: float = parameter(2.0, "gain g_D, of the damping", "1/um^2", ge=0, le=1e6)
        rate_gain: float = parameter(1.0, "gain g_O", "1/um^2", ge=0, le=1e6)
        advance: bool = parameter(False, "take the motion asked for half a sample later, by which a held force is late")

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
        along_y = math.sqrt(device.stiffness_y / device.mass_y)
        hz = [USUAL_SHARE * hz_of_rad_ms(omega) for omega in (device.natural_frequency, along_y)]
        fill_law(p, params, context, hz[0], hz[1], 1.0)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: AdaptiveRate.Ports) -> None:
        """Follow the motion asked for, and adapt while it drives: another motion says nothing of it."""
        q1, q2, v1, v2 = asked(p.asked, x.time_ms)
        e1, e2 = x.x_velocity - v1, x.y_velocity - v2
        x.error_x = x.x_measured - q1
        x.error_y = x.y_measured - q2
        if x.engaged != 0.0:
            adapt(p.gains, s, e1, e2, q1, q2, v1, v2)
        q1, q2, v1, v2 = asked(p.asked, x.time_ms + p.asked.ahead_ms)
        along, across = push(s, q1, q2, v1, v2)
        x.x = p.force_x * (along - p.asked.omega_x * p.asked.omega_x * q1 - p.gains.velocity * e1)
        x.y = p.force_y * (across - p.asked.omega_y * p.asked.omega_y * q2 - p.gains.velocity * e2)
        write(p.asked, s, x, p.mass)
