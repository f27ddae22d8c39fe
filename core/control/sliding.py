"""Switching surface, gains and boundary layer of the variable structure controllers."""

from __future__ import annotations

import math
from typing import Literal

from core.block import BlockParams, Context, Equation, Stage, parameter
from core.control.controller import ControllerPorts, NormalisedPacked, VelocityPorts, fill_normalised, saturated
from core.control.velocity import PackedVelocity, Source, VelocityState, velocity_of, velocity_source
from core.elementary import exp
from core.kernel import flush_tiny, kernel
from core.ports import tap
from core.record import Choice, Record

FADING = 1000.0
"""Time over which the peak of the needed layer fades, in 1/w0."""
LAYER_TOO_THIN = "the boundary layer is thinner than one sample of switching: the law chatters"
LAYER_EQUATION = Equation(
    "boundary layer",
    r"\Phi\ge\rho M|k_p|h",
    "3.2.4.2.1",
    printed=r"\mathrm{sgn}(s)",
    why="a sampled sign crosses the surface by a whole sample of switching: its error is proportional to the sample "
    "interval. A layer that one sample cannot cross takes the chatter away",
)
SURFACE_EQUATION = Equation(
    "surface",
    r"s=G\,[y_m-y,\;\dot y_m-\dot y]^T,\quad G=[\sqrt{Q/R},\;1]",
    "3.2.4.1.1, 3.2.4.2.6-8",
    printed=r"G=[1^T\;I]=I",
    why="G is a row of two; its first entry is 1 over a time, so Q = R = 1 means 64 us here and 1 s in SI",
)
GAINS_EQUATION = Equation(
    "gains",
    r"K_e=(GB)^{-1}GA_m,\quad K_p=(GB)^{-1}G(A_m-A_p),\quad K_m=(GB)^{-1}GB_m",
    "3.2.4.2.2-4",
    printed=r"K_p=(GB_p)^{-1}GA_p,\quad K_e=(GB_p)^{-1}G(A_m-A_p)",
    why="A_m x_m - A_p x_p = A_m e + (A_m - A_p) x_p; the printed pair still reaches the surface, at twice the effort",
)


SURFACE = Stage("Sliding surface", "model measured model_velocity velocity", "error surface", ("surface",))
BOUNDARY_LAYER = Stage("Boundary layer", "switching", "layer_needed layer_exceeded", ("boundary layer",))
"""Stages of every law that slides."""


class SwitchingParams(BlockParams):
    """Surface, boundary layer and source of the velocity."""

    surface_weight: float = parameter(
        1.0, "Q over R of the Riccati equation, in w0^2", equation="3.2.4.2.7", gt=0, le=100
    )
    layer_um: float = parameter(0.3, "boundary layer, 0 for a plain sign", "um", ge=0, le=100)
    velocity: Source = velocity_source()


class SlidingParams(SwitchingParams):
    """The sliding law with gains from the coefficients of the plant."""

    law: Literal["equivalent", "switching"] = parameter(
        "equivalent", "equivalent control with switching on top, or switching alone", equation="3.2.4.2.1"
    )
    switching_share: float | None = parameter(
        None, "share of the sum of all terms that switches; 0.3 beside the equivalent control, 1 alone", ge=0, le=10
    )
    gains: Literal["working", "printed"] = parameter(
        "working", "gains that follow from the surface, or as printed", equation="3.2.4.2.2-3"
    )


class SwitchingPacked(NormalisedPacked):
    """Every switching law: sign of the gain, surface, boundary layer, share of its peak that is kept, velocity."""

    sign: float
    surface_gain: float
    layer_um: float
    fade: float
    velocity: PackedVelocity


class SlidingPacked(SwitchingPacked):
    """In addition, for the laws that compute their gains from coefficients of second order."""

    share: float
    equivalent: float
    printed: Choice


class SwitchingState(Record):
    """Peak of the needed layer, and the velocity source."""

    peak: float
    velocity: VelocityState


class SwitchingPorts(ControllerPorts, VelocityPorts):
    """Ports of a controller with velocity, and the surface and switching of the law."""

    error: float = tap("um", "model minus measured displacement")
    surface: float = tap("um", "distance s from the switching surface, velocity in um per 1/w0")
    equivalent: float = tap("V", "equivalent control")
    switching: float = tap("V", "amplitude of the switching part")
    layer_needed: float = tap("um", "thinnest boundary layer without chatter, its peak of late")
    layer_exceeded: float = tap(
        "1", "1 while it drives with a boundary layer thinner than that", warning=LAYER_TOO_THIN
    )


def fill_sliding(p: SlidingPacked, params: SlidingParams, context: Context) -> None:
    """Pack the numbers of a law that computes its gains from coefficients of second order."""
    fill_switching(p, params, context)
    usual = 0.3 if params.law == "equivalent" else 1.0
    p.share = usual if params.switching_share is None else params.switching_share
    p.equivalent = params.law == "equivalent"
    p.printed = params.gains == "printed"


def fill_switching(p: SwitchingPacked, params: SwitchingParams, context: Context) -> None:
    """Pack the numbers of every switching law, with coefficients in units of the rate of the device."""
    fill_normalised(p, context)
    p.sign = math.copysign(1.0, p.plant.gain)
    p.surface_gain = math.sqrt(params.surface_weight)
    p.fade = exp(-p.h / FADING)
    p.velocity = velocity_of(params.velocity, context)


@kernel
def slide(
    p: SlidingPacked,
    s: SwitchingState,
    x: SwitchingPorts,
    y: float,
    v: float,
    a1: float,
    a2: float,
    gain: float,
    instead: float,
    use_instead: bool,
) -> float:
    """Return the voltage of the law for these plant coefficients, and write its taps.

    The velocity is in um per 1/w0; ``instead`` replaces the surface if ``use_instead`` is true.
    """
    e = x.model - y
    de = x.model_velocity / p.velocity.rate - v
    g1 = p.surface_gain
    surface = instead if use_instead else g1 * e + de
    on_e, on_de = -p.model.a2, g1 - p.model.a1
    on_y, on_v = a2 - p.model.a2, a1 - p.model.a1
    if p.printed != 0.0:
        on_e, on_de, on_y, on_v = on_y, on_v, -a2, g1 - a1
    inverse = 1.0 / gain
    terms = (on_e * e, on_de * de, on_y * y, on_v * v, p.model.gain * x.reference)
    equivalent = (terms[0] + terms[1] + terms[2] + terms[3] + terms[4]) * inverse * p.equivalent
    size = abs(terms[0]) + abs(terms[1]) + abs(terms[2]) + abs(terms[3]) + abs(terms[4])
    amplitude = p.share * size * abs(inverse)
    return equivalent + switch(p, s, x, e, surface, equivalent, amplitude, gain)


@kernel
def switch(
    p: SwitchingPacked,
    s: SwitchingState,
    x: SwitchingPorts,
    e: float,
    surface: float,
    equivalent: float,
    amplitude: float,
    gain: float,
) -> float:
    """Return the switching part, and write the taps."""
    needed = amplitude * abs(gain) * p.h
    s.peak = flush_tiny(max(needed, s.peak * p.fade))
    x.error = e
    x.surface = surface
    x.equivalent = equivalent
    x.switching = amplitude
    x.layer_needed = s.peak
    x.layer_exceeded = 1.0 if s.peak > p.layer_um and x.engaged != 0.0 else 0.0
    return amplitude * saturated(surface, p.layer_um) * p.sign
