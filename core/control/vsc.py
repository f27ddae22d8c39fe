"""Variable structure control with the gains of the nominal device."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Block, Context, Equation, FloatArray, Oscillator
from core.control.controller import APPLIED, MEASURED, OUTPUT, unsuited_second_order
from core.control.sliding import (
    GAINS_EQUATION,
    LAYER_EQUATION,
    PLANT_A1,
    PLANT_A2,
    PLANT_GAIN,
    RATE,
    SLIDING_INPUTS,
    SLIDING_SIZE,
    SLIDING_TAPS,
    SURFACE_EQUATION,
    VELOCITY,
    SlidingParams,
    pack_sliding,
    slide,
)
from core.control.velocity import STATES, pack_velocity, velocity
from core.voltage import moved

PEAK, MOTION = 0, 1
OWN_VOLTAGE = len(SLIDING_INPUTS)


def vsc_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Slide with the nominal coefficients."""
    y = w[io[MEASURED]]
    u, middle, end = moved(w, io, APPLIED)
    v = velocity(p, SLIDING_SIZE, s, MOTION, w[io[VELOCITY]], y, u, middle, end) / p[RATE]
    w[io[OWN_VOLTAGE]] = slide(
        p, s, PEAK, w, io, OWN_VOLTAGE + 1, y, v, p[PLANT_A1], p[PLANT_A2], p[PLANT_GAIN], 0.0, False
    )


class Vsc(Block):
    r"""Variable structure control with fixed gains, :math:`u=u_{eq}+\rho M\,\mathrm{sat}(s/\Phi)`.

    The gains are those of the nominal device: once the true one asks for more than they allow for, the surface is not
    reached, which is what self-tuning is for.
    """

    title = "Variable structure control"
    inputs = SLIDING_INPUTS
    outputs = (OUTPUT,)
    taps = SLIDING_TAPS
    equations = (
        Equation("law", r"u=u_{eq}+\rho M\,\mathrm{sat}(s/\Phi),\quad M=\sum|K_{e,i}e_i|+|K_{p,i}x_i|+|K_mr|", "3.2.4"),
        SURFACE_EQUATION,
        GAINS_EQUATION,
        LAYER_EQUATION,
    )
    Params = SlidingParams

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants and models that are not of second order."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        shared = pack_sliding(params, context)
        return np.array([*shared, *pack_velocity(params.velocity, context, shared[RATE])])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Peak of the layer needed, and the velocity source."""
        return np.zeros(MOTION + STATES)

    step = vsc_step
