"""Recovery from two beams: the phase of the pair, unwrapped."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.sense.dual_beam import DualBeam
from core.sense.sensor import (
    ERROR_PORT,
    LAST_PORT,
    RECOVERED_PORT,
    SLIPS_PORT,
    TRUE_PORT,
    Sensor,
    SensorParams,
    begin_at,
    calibrated,
    slips,
)

MEAN, AMPLITUDE, COSINE, SINE, PITCH, OFFSET = range(6)
LAST, FIRST, SECOND, TRUE, DISPLACEMENT, ERROR, TURN, SLIPS = range(8)
TWO_PI = 2.0 * math.pi


def quadrature_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Take the phase of the pair and unwrap it."""
    cosine = (w[io[FIRST]] - p[MEAN]) / p[AMPLITUDE]
    # the second beam sees cos(phase - delta)
    sine = ((w[io[SECOND]] - p[MEAN]) / p[AMPLITUDE] - p[COSINE] * cosine) / p[SINE]
    if math.isfinite(cosine) and math.isfinite(sine):
        if s[0] == 0.0:
            s[0] = 1.0
            s[1] = (begin_at(w[io[LAST]]) - p[OFFSET]) / p[PITCH]
        turn = math.atan2(sine, cosine) / TWO_PI
        s[1] = turn + math.floor(s[1] - turn + 0.5)
        w[io[TURN]] = turn
        w[io[DISPLACEMENT]] = p[OFFSET] + p[PITCH] * s[1]
    error = w[io[DISPLACEMENT]] - w[io[TRUE]]
    w[io[ERROR]] = error
    w[io[SLIPS]] = slips(error, p[PITCH])


class Quadrature(Sensor):
    r"""Displacement from the phase of two beams (6.3).

    .. math:: x=x_0+\frac{\Lambda}{2\pi}\,\mathrm{unwrap}\,\mathrm{atan2}(\sin\varphi,\cos\varphi),\qquad
        \sigma_x=\frac{\Lambda}{2\pi\sqrt2}10^{-SNR/20}

    14.2 nm at 30 dB for a pitch of 4 um. A spacing that is 0.1 um off turns the circle into an ellipse, an error of
    about 50 nm at its peak; told the true spacing, the unit corrects it (Heydemann 1981, the phase term only).
    """

    title = "Quadrature with unwrap"
    inputs = (
        LAST_PORT,
        Port("first", "1", "light of the first beam", source="dual_beam.first"),
        Port("second", "1", "light of the second beam", source="dual_beam.second"),
        TRUE_PORT,
    )
    outputs = (RECOVERED_PORT,)
    taps = (
        ERROR_PORT,
        Port("turn", "1", "phase of the pair, in turns from -1/2 to 1/2"),
        SLIPS_PORT,
    )
    equations = (
        Equation(
            "phase",
            r"\varphi=\mathrm{atan2}\!\left(\frac{\hat I_b-\hat I_a\cos\delta}{\sin\delta},\hat I_a\right),"
            r"\quad\hat I=\frac{I-\bar I}{c_1},\;\delta=\frac{2\pi s}{\Lambda}",
            "6.3 in words",
        ),
        Equation("displacement", r"x=x_0+\frac{\Lambda}{2\pi}\,\mathrm{unwrap}\,\varphi"),
    )

    class Params(SensorParams):
        """What it assumes of the pair."""

        spacing_um: float = parameter(1.0, "distance between the beams it assumes", "um", ge=0.01, le=100)

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the noise of the phase as displacement."""
        return calibrated(context, "dual_beam", DualBeam.Params).phase_noise_um

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step, with the grating as calibrated."""
        pair = calibrated(context, "dual_beam", DualBeam.Params)
        delta = TWO_PI * params.spacing_um / pair.pitch_um
        sine = math.sin(delta)
        # beams half a pitch apart tell nothing of the direction; the unit then amplifies noise, but stays finite
        sine = math.copysign(max(abs(sine), 1e-3), sine)
        offset = pair.offset(context.seed)
        return np.array([pair.mean, pair.harmonics[0], math.cos(delta), sine, pair.pitch_um, offset])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Whether it has run, and the unwrapped phase in turns."""
        return np.zeros(2)

    step = quadrature_step
