"""Recovery from two beams with a Kalman filter that knows the device and the voltage."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Oscillator, Port
from core.sense import tracker
from core.sense.dual_beam import DualBeam
from core.sense.sensor import (
    ENGAGED_PORT,
    ERROR_PORT,
    LAST_PORT,
    RECOVERED_PORT,
    SLIPS_PORT,
    TRUE_PORT,
    Sensor,
    calibrated,
    rest,
    slips,
)
from core.sense.tracker import APPLIED_PORT, FILTER, MOTION, TrackerParams, coast, correct, predict, take_over

PITCH, OFFSET, NOISE, MODEL = range(4)
ENGAGED, LAST, TURN, APPLIED, TRUE, DISPLACEMENT, ERROR, RESIDUAL, SLIPS = range(9)
RUNNING, FRESH, OWN = 0, 1, 1 + FILTER
"""State: whether it runs, a filter to start from, the filter."""


def quadrature_kalman_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, unwrap the phase about the prediction, correct."""
    if w[TICK] > 0.0:
        coast(p, MODEL, s, FRESH, w[io[APPLIED]])
    if w[io[ENGAGED]] == 0.0:
        s[RUNNING] = 0.0
        rest(w, io, DISPLACEMENT, SLIPS)
        return
    if s[RUNNING] == 0.0:
        s[RUNNING] = 1.0
        take_over(s, FRESH, OWN, w[io[LAST]])
    else:
        predict(p, MODEL, s, OWN, w[io[APPLIED]])
    x = s[OWN + tracker.X]
    ahead = (x - p[OFFSET]) / p[PITCH] - w[io[TURN]]
    residual = p[PITCH] * (math.floor(ahead + 0.5) - ahead) if math.isfinite(ahead) else 0.0
    correct(s, OWN, residual, 1.0, p[NOISE])
    error = s[OWN + tracker.X] - w[io[TRUE]]
    w[io[DISPLACEMENT]] = s[OWN + tracker.X]
    w[io[ERROR]] = error
    w[io[RESIDUAL]] = residual
    w[io[SLIPS]] = slips(error, p[PITCH])


class QuadratureKalman(Sensor):
    r"""The phase of two beams through a Kalman filter on :math:`(x,\dot x,f)`, unwrapped about its prediction (6.3).

    The filter knows the nominal device and the voltage; what the model lacks goes into the slow force :math:`f`.
    """

    title = "Quadrature with Kalman filter"
    inputs = (
        ENGAGED_PORT,
        LAST_PORT,
        Port("turn", "1", "phase of the pair, in turns", source="quadrature.turn"),
        APPLIED_PORT,
        TRUE_PORT,
    )
    outputs = (RECOVERED_PORT,)
    taps = (
        ERROR_PORT,
        Port("residual", "um", "phase, as displacement, minus prediction"),
        SLIPS_PORT,
    )
    equations = (
        MOTION,
        Equation(
            "residual", r"r=\Lambda\left\langle\frac{\varphi}{2\pi}-\frac{x^--x_0}{\Lambda}\right\rangle_{\pm1/2}"
        ),
    )

    class Params(TrackerParams):
        """What it assumes of the shuttle."""

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the noise of the phase as displacement; the filter's own error is smaller but not white."""
        return calibrated(context, "dual_beam", DualBeam.Params).phase_noise_um

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse what its model cannot be."""
        return tracker.unsuited(device)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        pair = calibrated(context, "dual_beam", DualBeam.Params)
        noise = max(pair.phase_noise_um, 1e-6)
        own = [pair.pitch_um, pair.offset(context.seed), noise * noise]
        return np.array(own + tracker.pack_model(params, context))

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Whether it runs, a filter to start from, the filter."""
        return np.array([0.0, *tracker.start(params, context), *[0.0] * FILTER])

    step = quadrature_kalman_step
