"""What the variable structure controllers share: switching surface, gains, boundary layer."""

from __future__ import annotations

import math
from typing import Any, Literal

from core.block import BlockParams, Context, Equation, Port, kernel, parameter, settled
from core.control.controller import ENGAGED, INPUTS, VELOCITY_INPUTS, coefficients, saturated
from core.control.velocity import Source, velocity_source

TIME_STEP, RATE, SIGN, MODEL_A1, MODEL_A2, MODEL_GAIN, PLANT_A1, PLANT_A2, PLANT_GAIN = range(9)
SURFACE_GAIN, LAYER, FADE, SWITCHING_SIZE = range(9, 13)
"""Packed parameters of every switching law; its own follow."""
SHARE, EQUIVALENT, PRINTED_GAINS, SLIDING_SIZE = range(SWITCHING_SIZE, SWITCHING_SIZE + 4)
"""Those of the laws that compute their gains from coefficients."""
FADING = 1000.0
"""Time over which the peak of the layer needed is forgotten, in 1/w0."""

VELOCITY, MODEL_VELOCITY = len(INPUTS), len(INPUTS) + 1
SLIDING_INPUTS = (*INPUTS, *VELOCITY_INPUTS)
LAYER_TOO_THIN = "the boundary layer is thinner than one sample of switching: the law chatters"
SLIDING_TAPS = (
    Port("error", "um", "model minus measured displacement"),
    Port("surface", "um", "distance s from the switching surface, velocity in um per 1/w0"),
    Port("equivalent", "V", "equivalent control"),
    Port("switching", "V", "amplitude of the switching part"),
    Port("layer_needed", "um", "thinnest boundary layer without chatter, its peak of late"),
    Port("layer_exceeded", "1", "1 while it drives with a boundary layer thinner than that", warning=LAYER_TOO_THIN),
)
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


class SwitchingParams(BlockParams):
    """Surface, boundary layer and where the velocity is from."""

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


def pack_sliding(params: SlidingParams, context: Context) -> list[float]:
    """Pack what the laws need that compute their gains from coefficients of second order."""
    usual = 0.3 if params.law == "equivalent" else 1.0
    return [
        *pack_switching(params, context),
        usual if params.switching_share is None else params.switching_share,
        float(params.law == "equivalent"),
        float(params.gains == "printed"),
    ]


def pack_switching(params: SwitchingParams, context: Context) -> list[float]:
    """Pack what every switching law needs, the coefficients in units of the rate of the device."""
    rate = context.device.natural_frequency
    h = context.dt_ms * rate
    plant, model = coefficients(context)
    sign, fade = math.copysign(1.0, plant[2]), math.exp(-h / FADING)
    return [h, rate, sign, *model, *plant, math.sqrt(params.surface_weight), params.layer_um, fade]


@kernel
def slide(
    p: Any,
    s: Any,
    peak: int,
    w: Any,
    io: Any,
    first: int,
    y: float,
    v: float,
    a1: float,
    a2: float,
    gain: float,
    instead: float,
    use_instead: bool,
) -> float:
    """Return the voltage of the law for these plant coefficients, and write its taps, which begin at ``first``.

    The velocity is in um per 1/w0; ``instead`` takes the place of the surface where it is used.
    """
    e = w[io[1]] - y
    de = w[io[MODEL_VELOCITY]] / p[RATE] - v
    g1 = p[SURFACE_GAIN]
    surface = instead if use_instead else g1 * e + de
    on_e, on_de = -p[MODEL_A2], g1 - p[MODEL_A1]
    on_y, on_v = a2 - p[MODEL_A2], a1 - p[MODEL_A1]
    if p[PRINTED_GAINS] != 0.0:
        on_e, on_de, on_y, on_v = on_y, on_v, -a2, g1 - a1
    inverse = 1.0 / gain
    terms = (on_e * e, on_de * de, on_y * y, on_v * v, p[MODEL_GAIN] * w[io[0]])
    equivalent = (terms[0] + terms[1] + terms[2] + terms[3] + terms[4]) * inverse * p[EQUIVALENT]
    size = abs(terms[0]) + abs(terms[1]) + abs(terms[2]) + abs(terms[3]) + abs(terms[4])
    amplitude = p[SHARE] * size * abs(inverse)
    return float(equivalent + switch(p, s, peak, w, io, first, e, surface, equivalent, amplitude, gain))


@kernel
def switch(
    p: Any,
    s: Any,
    peak: int,
    w: Any,
    io: Any,
    first: int,
    e: float,
    surface: float,
    equivalent: float,
    amplitude: float,
    gain: float,
) -> float:
    """Return the switching part, and write the taps."""
    needed = amplitude * abs(gain) * p[TIME_STEP]
    s[peak] = settled(max(needed, s[peak] * p[FADE]))
    w[io[first]] = e
    w[io[first + 1]] = surface
    w[io[first + 2]] = equivalent
    w[io[first + 3]] = amplitude
    w[io[first + 4]] = s[peak]
    w[io[first + 5]] = 1.0 if s[peak] > p[LAYER] and w[io[ENGAGED]] != 0.0 else 0.0
    return float(amplitude * saturated(surface, p[LAYER]) * p[SIGN])
