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
from core.sense.tracker import FILTER, MOTION, Tracker, TrackerParams, V, X, gather, predict
from core.voltage import APPLIED_PORTS, BEGUN
from core.voltage import STATES as VOLTAGE_STATES

LAST, PAST, LIGHT, APPLIED = range(4)
TRUE, DISPLACEMENT, ERROR, ACTIVE, ALIVE, SWITCHES, SLIPS = (APPLIED + len(APPLIED_PORTS) + n for n in range(7))
DRIVE = OWN + MOST * WIDTH
"""State behind the hypotheses: the voltage."""


def single_beam_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Follow every hypothesis and put out the likeliest."""
    if gather(p, MODEL, s, DRIVE, w, io, APPLIED):
        return
    first = False
    if s[STARTED] == 0.0:
        s[STARTED] = 1.0
        first = not catch_up(p, MODEL, s, OWN, DRIVE, w, io, PAST, APPLIED)
        if first:
            s[OWN + X] = begin_at(w[io[LAST]])
    z = w[io[LIGHT]]
    for i in range(MOST):
        b = OWN + i * WIDTH
        if s[b + USED] == YES:
            x = s[b + X]
            v = s[b + V]
            if not first:
                predict(p, MODEL, s, b, DRIVE)
            if math.isfinite(z):
                follow(p, s, b, z)
                turns(p, s, b, x, v)
    s[DRIVE + BEGUN] = 0.0
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
        *APPLIED_PORTS,
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

    weaknesses = (
        "Below 500 Hz the force it leaves to what its model lacks explains a turn as well as the drive does, and the "
        "direction gets lost: at 4 um of stroke and 30 dB in 23 % of the samples at 159 Hz, two in three places of the "
        "grating, and in 1 % at 300 Hz; in none at 1 kHz. With force_rate_per_ms = 0.4 instead of 4 none is lost at "
        "159 Hz either, also with 10 % more stiffness than it knows of.",
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
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return the pitch of the grating it looks at."""
        return calibrated(context, "through_wafer", ThroughWafer.Params).pitch_um

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
        ]
        return np.array(own + tracker.pack_model(params, context) + beam.packed(context))

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Whether it has run, the best hypothesis, changes of it, the hypotheses: one."""
        start = np.zeros(DRIVE + VOLTAGE_STATES)
        start[OWN : OWN + FILTER] = tracker.start(params, context)
        start[OWN + USED] = YES
        return start

    step = single_beam_step
