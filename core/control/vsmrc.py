"""Variable structure model reference control."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Block, Context, Equation, FloatArray, parameter
from core.control.controller import APPLIED, MEASURED, MODEL, OUTPUT, REFERENCE
from core.control.sliding import (
    EQUIVALENT,
    LAYER_EQUATION,
    MODEL_A1,
    MODEL_A2,
    MODEL_GAIN,
    MODEL_VELOCITY,
    PLANT_A1,
    PLANT_A2,
    PLANT_GAIN,
    RATE,
    SLIDING_INPUTS,
    SLIDING_SIZE,
    SLIDING_TAPS,
    SURFACE_EQUATION,
    SURFACE_GAIN,
    VELOCITY,
    SlidingParams,
    pack_sliding,
    switch,
)
from core.control.velocity import STATES, VELOCITY_SIZE, pack_velocity, velocity

PEAK, MOTION = 0, 1
REFERENCE_BOUND, OUTPUT_BOUND, OWN_SIZE = range(SLIDING_SIZE + VELOCITY_SIZE, SLIDING_SIZE + VELOCITY_SIZE + 3)
OWN_VOLTAGE = len(SLIDING_INPUTS)


def vsmrc_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Match the model with nominal gains and switch with bounds on what is missing."""
    y = w[io[MEASURED]]
    r = w[io[REFERENCE]]
    v = velocity(p, SLIDING_SIZE, s, MOTION, w[io[VELOCITY]], y, w[io[APPLIED]]) / p[RATE]
    e = w[io[MODEL]] - y
    surface = p[SURFACE_GAIN] * e + w[io[MODEL_VELOCITY]] / p[RATE] - v
    nominal = p[MODEL_GAIN] * r + (p[PLANT_A2] - p[MODEL_A2]) * y + (p[PLANT_A1] - p[MODEL_A1]) * v
    nominal *= p[EQUIVALENT] / p[PLANT_GAIN]
    amplitude = p[REFERENCE_BOUND] * abs(r) + p[OUTPUT_BOUND] * abs(y)
    w[io[OWN_VOLTAGE]] = nominal + switch(
        p, s, PEAK, w, io, OWN_VOLTAGE + 1, e, surface, nominal, amplitude, p[PLANT_GAIN]
    )
