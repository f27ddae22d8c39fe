"""Variable structure model reference control."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Block, Context, Equation, FloatArray, Oscillator, parameter
from core.control.controller import APPLIED, MEASURED, MODEL, OUTPUT, REFERENCE, unsuited_order
from core.control.sliding import (
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
    SLIDING_TAPS,
    SURFACE_GAIN,
    SWITCHING_SIZE,
    VELOCITY,
    SwitchingParams,
    pack_switching,
    switch,
)
from core.control.velocity import STATES, pack_velocity, velocity
from core.voltage import moved

NOMINAL, REFERENCE_BOUND, OUTPUT_BOUND, SECOND_ORDER, MOVING = range(SWITCHING_SIZE, SWITCHING_SIZE + 5)
PEAK, MOTION = 0, 1
OWN_VOLTAGE = len(SLIDING_INPUTS)


def vsmrc_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Match the model with nominal gains, and switch with bounds on what these miss."""
    y = w[io[MEASURED]]
    r = w[io[REFERENCE]]
    u, middle, end = moved(w, io, APPLIED)
    v = velocity(p, MOVING, s, MOTION, w[io[VELOCITY]], y, u, middle, end) / p[RATE]
    e = w[io[MODEL]] - y
    surface = e
    if p[SECOND_ORDER] != 0.0:
        surface = p[SURFACE_GAIN] * e + w[io[MODEL_VELOCITY]] / p[RATE] - v
    nominal = p[MODEL_GAIN] * r + (p[PLANT_A2] - p[MODEL_A2]) * y + (p[PLANT_A1] - p[MODEL_A1]) * v
    nominal *= p[NOMINAL] / p[PLANT_GAIN]
    amplitude = p[REFERENCE_BOUND] * abs(r) + p[OUTPUT_BOUND] * abs(y)
    w[io[OWN_VOLTAGE]] = nominal + switch(
        p, s, PEAK, w, io, OWN_VOLTAGE + 1, e, surface, nominal, amplitude, p[PLANT_GAIN]
    )


class Vsmrc(Block):
    r"""Variable structure model reference control, :math:`u=\theta_{nom}^Tw+(c_r|r|+c_y|y|)\,\mathrm{sat}(s/\Phi)`.

    Instead of adapting, it switches with as much as the gains may be wrong by. A boundary layer leaves an offset: in it
    the switching is a plain gain.
    """

    title = "Variable structure MRC"
    inputs = SLIDING_INPUTS
    outputs = (OUTPUT,)
    taps = SLIDING_TAPS
    equations = (
        Equation("law", r"u=\theta_{nom}^T[r,y,\dot y]+(c_r|r|+c_y|y|)\,\mathrm{sat}(s/\Phi)", "4.3.1"),
        Equation(
            "surface", r"s=y_m-y\;\text{(first order)},\quad s=g_1(y_m-y)+\dot y_m-\dot y\;\text{(second)}", "4.1"
        ),
        LAYER_EQUATION,
    )

    class Params(SwitchingParams):
        """How much the nominal gains may be wrong by."""

        nominal: bool = parameter(True, "feed the gains that match the nominal device; off leaves all to the switching")
        reference_bound: float = parameter(0.2, "voltage switched per volt of reference, c_r", ge=0, le=100)
        output_bound_v_um: float | None = parameter(
            None, "voltage switched per displacement, c_y; unless given, what holds the device there", "V/um", ge=0
        )

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse a model of another kind than the plant."""
        return unsuited_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        device, rate = context.device, context.device.natural_frequency
        bound = params.output_bound_v_um
        if bound is None:
            bound = abs(device.stiffness / device.force) if device.force != 0.0 else 0.0
        return np.array(
            [
                *pack_switching(params, context),
                float(params.nominal),
                params.reference_bound,
                bound,
                float(device.mass > 0.0),
                *pack_velocity(params.velocity, context, rate),
            ]
        )

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Peak of the layer needed, and the velocity source."""
        return np.zeros(MOTION + STATES)

    step = vsmrc_step
