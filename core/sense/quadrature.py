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


def separation(spacing_um: float, pitch_um: float) -> tuple[float, float]:
    """Return cosine and sine of the phase between the beams.

    Beams half a pitch apart tell nothing of the direction; the unit then amplifies noise, but stays finite.
    """
    delta = TWO_PI * spacing_um / pitch_um
    sine = math.sin(delta)
    return math.cos(delta), math.copysign(max(abs(sine), 1e-3), sine)


class Quadrature(Sensor):
    r"""Displacement from the phase of two beams (6.3).

    .. math:: x=x_0+\frac{\Lambda}{2\pi}\,\mathrm{unwrap}\,\mathrm{atan2}(\sin\varphi,\cos\varphi),\qquad
        \sigma_x=\frac{\Lambda}{2\pi\sqrt2}\,\frac{10^{-SNR/20}}{|\sin\delta|}

    the root of the mean over a pitch of :math:`\mathrm{var}\,\varphi=\sigma_I^2
    [\cos^2\varphi+\cos^2(\varphi-\delta)]/(c_1\sin\delta)^2`. 14.2 nm at 30 dB for a pitch of 4 um and a spacing of
    1 um. A spacing that is 0.1 um off turns the circle into an ellipse, an error of
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
        pair = calibrated(context, "dual_beam", DualBeam.Params)
        return pair.phase_noise_um / abs(separation(params.spacing_um, pair.pitch_um)[1])

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return the pitch of the grating it looks at."""
        return calibrated(context, "dual_beam", DualBeam.Params).pitch_um

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step, with the grating as calibrated."""
        pair = calibrated(context, "dual_beam", DualBeam.Params)
        apart = separation(params.spacing_um, pair.pitch_um)
        offset = pair.offset(context.seed)
        return np.array([pair.mean, pair.harmonics[0], *apart, pair.pitch_um, offset])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Whether it has run, and the unwrapped phase in turns."""
        return np.zeros(2)

    step = quadrature_step
