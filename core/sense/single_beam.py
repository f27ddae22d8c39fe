"""Recovery from one beam: several Kalman filters that know the device, one for each way a turn may have gone."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, Equation, FloatArray, Port, parameter
from core.sense import tracker
from core.sense.grating import WAVE
from core.sense.hypotheses import (
    BEST,
    CHANGES,
    EVERY,
    GRATING,
    MODEL,
    MOST,
    OWN,
    STARTED,
    USED,
    WIDTH,
    YES,
    follow,
    sift,
    turns,
)
from core.sense.past import PAST_PORT, catch_up
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
from core.sense.through_wafer import ThroughWafer
from core.sense.tracker import APPLIED_PORT, FILTER, MOTION, Tracker, TrackerParams, V, X, predict

LAST, PAST, LIGHT, APPLIED, TRUE, DISPLACEMENT, ERROR, ACTIVE, ALIVE, SWITCHES, SLIPS = range(11)


def single_beam_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Follow every hypothesis and put out the likeliest."""
    first = False
    if s[STARTED] == 0.0:
        s[STARTED] = 1.0
        first = not catch_up(p, MODEL, s, OWN, w, io[PAST], int(p[EVERY]))
        if first:
            s[OWN + X] = begin_at(w[io[LAST]])
    z = w[io[LIGHT]]
    for i in range(MOST):
        b = OWN + i * WIDTH
        if s[b + USED] == YES:
            x = s[b + X]
            v = s[b + V]
            if not first:
                predict(p, MODEL, s, b, w[io[APPLIED]])
            if math.isfinite(z):
                follow(p, s, b, z)
                turns(p, s, b, x, v)
    left = sift(p, s)
    x = s[OWN + int(s[BEST]) * WIDTH + X]
    error = x - w[io[TRUE]]
    pitch = 2.0 * math.pi / p[GRATING + WAVE]
    w[io[DISPLACEMENT]] = x
    w[io[ERROR]] = error
    w[io[ACTIVE]] = 1.0
    w[io[ALIVE]] = left
    w[io[SWITCHES]] = s[CHANGES]
    w[io[SLIPS]] = slips(error, pitch)


class SingleBeam(Tracker):
    r"""Displacement from one beam by several extended Kalman filters that know the device and the voltage.

    The light is the same on both sides of each of its extremes, :math:`I(2x_e-x)=I(x)`. So whenever a hypothesis
    passes an extreme, or turns near one, its reflection :math:`(2x_e-x,-\dot x)` is followed as well, at most ten in
    all; only one of the two keeps obeying the equation of motion. The likeliest is put out, by a likelihood with a
    memory of a few periods of the drive. While the stiffness is known to 30 % one filter would do; beyond that it
    slips, and the reflections bring it back.

    It costs as much as the rest of the bench together while it runs. It begins with the place and the speed that
    one filter makes of what was measured over the last samples.
    The text leaves the unit to others (2.2.3: Dawson 2000, 2002; Wang 2005); this one is the bench's own.
    """

    title = "Single beam, several hypotheses"
    inputs = (
        LAST_PORT,
        PAST_PORT,
        Port("light", "1", "light through the wafer", source="through_wafer.intensity"),
        APPLIED_PORT,
        TRUE_PORT,
    )
    outputs = (RECOVERED_PORT,)
    taps = (
        ERROR_PORT,
        Port("active", "1", "0 while it rests"),
        Port("hypotheses", "1", "hypotheses followed"),
        Port("switches", "1", "how often another hypothesis became the likeliest"),
        SLIPS_PORT,
    )
    equations = (
        MOTION,
        Equation("reflection", r"x'=2x_e-x,\quad\dot x'=-\dot x"),
        Equation(
            "likelihood",
            r"\ell\leftarrow\lambda\ell-\tfrac{r^2}{2\psi}-\tfrac12\ln\psi,\quad"
            r"\psi=I'^2P_{11}+\tfrac12I''^2P_{11}^2+R",
        ),
    )

    class Params(TrackerParams):
        """What it assumes of the shuttle, and how it treats hypotheses."""

        memory_ms: float = parameter(2.8, "memory of the likelihood", "ms", gt=0, le=1e4)
        reflection_odds: float = parameter(25.0, "logarithm of the odds against a reflection", ge=0, le=100)
        drop: float = parameter(40.0, "log-likelihood below the best at which a hypothesis is dropped", gt=0, le=1e4)
        near_um: float = parameter(0.5, "turns this near an extreme are reflected", "um", ge=0, le=100)

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the noise of a pair of beams of the same quality; the filter's own error is close to it."""
        return calibrated(context, "through_wafer", ThroughWafer.Params).phase_noise_um

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step, with the grating as calibrated."""
        beam = calibrated(context, "through_wafer", ThroughWafer.Params)
        noise = max(beam.noise, 1e-4 * abs(beam.harmonics[0]), 1e-30)
        own = [
            noise * noise,
            math.exp(-context.dt_ms / params.memory_ms),
            params.reflection_odds,
            params.drop,
            params.near_um,
            0.0125 * beam.pitch_um,
            0.025 * beam.pitch_um * context.device.natural_frequency,
            context.every,
        ]
        return np.array(own + tracker.pack_model(params, context) + beam.packed(context))

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Whether it has run, the best hypothesis, changes of it, the hypotheses: one."""
        start = np.zeros(OWN + MOST * WIDTH)
        start[OWN : OWN + FILTER] = tracker.start(params, context)
        start[OWN + USED] = YES
        return start

    step = single_beam_step
