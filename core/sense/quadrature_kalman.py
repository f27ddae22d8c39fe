"""Recovery from two beams with a Kalman filter that knows the device and the voltage."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, Port
from core.sense import tracker
from core.sense.dual_beam import DualBeam
from core.sense.quadrature import Quadrature
from core.sense.sensor import (
    ERROR_PORT,
    LAST_PORT,
    RECOVERED_PORT,
    SLIPS_PORT,
    TRUE_PORT,
    begin_at,
    calibrated,
    slips,
)
from core.sense.tracker import FILTER, MOTION, Tracker, TrackerParams, X, correct, gather, predict
from core.voltage import APPLIED_PORTS, BEGUN
from core.voltage import STATES as VOLTAGE_STATES

PITCH, OFFSET, NOISE, MODEL = range(4)
LAST, TURN, APPLIED = range(3)
TRUE, DISPLACEMENT, ERROR, RESIDUAL, SLIPS = range(APPLIED + len(APPLIED_PORTS), APPLIED + len(APPLIED_PORTS) + 5)
STARTED, OWN, DRIVE = 0, 1, 1 + FILTER
"""State: whether it has run, the filter, the voltage."""


def quadrature_kalman_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Predict, unwrap the phase about the prediction, correct."""
    if gather(p, MODEL, s, DRIVE, w, io, APPLIED):
        return
    if s[STARTED] == 0.0:
        s[STARTED] = 1.0
        s[OWN + X] = begin_at(w[io[LAST]])
    else:
        predict(p, MODEL, s, OWN, DRIVE)
    s[DRIVE + BEGUN] = 0.0
    x = s[OWN + X]
    ahead = (x - p[OFFSET]) / p[PITCH] - w[io[TURN]]
    residual = p[PITCH] * (math.floor(ahead + 0.5) - ahead) if math.isfinite(ahead) else 0.0
    correct(s, OWN, residual, 1.0, p[NOISE])
    error = s[OWN + X] - w[io[TRUE]]
    w[io[DISPLACEMENT]] = s[OWN + X]
    w[io[ERROR]] = error
    w[io[RESIDUAL]] = residual
    w[io[SLIPS]] = slips(error, p[PITCH])


class QuadratureKalman(Tracker):
    r"""The phase of two beams through a Kalman filter on :math:`(x,\dot x,f)`, unwrapped about its prediction (6.3).

    The filter knows the nominal device and the voltage; what the model lacks goes into the slow force :math:`f`.
    """

    title = "Quadrature with Kalman filter"
    inputs = (
        LAST_PORT,
        Port("turn", "1", "phase of the pair, in turns", source="quadrature.turn"),
        *APPLIED_PORTS,
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
        return Quadrature.noise_um(calibrated(context, "quadrature", Quadrature.Params), context)

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return the pitch of the grating it looks at."""
        return calibrated(context, "dual_beam", DualBeam.Params).pitch_um

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        pair = calibrated(context, "dual_beam", DualBeam.Params)
        noise = max(cls.noise_um(params, context), 1e-6)
        own = [pair.pitch_um, pair.offset(context.seed), noise * noise]
        return np.array(own + tracker.pack_model(params, context))

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Whether it has run, the filter, no voltage yet."""
        return np.array([0.0, *tracker.start(params, context), *[0.0] * VOLTAGE_STATES])

    step = quadrature_kalman_step
