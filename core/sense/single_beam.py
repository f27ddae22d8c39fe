"""Recovery from one beam: several Kalman filters that know the device, one for each way a turn may have gone."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, parameter
from core.elementary import exp
from core.ports import BlockPorts, reads, tap
from core.record import Records
from core.sense.hypotheses import MOST, YES, Followed, Odds, follow, sift, turns
from core.sense.past import PAST_PORT, Entry, catch_up
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
from core.sense.tracker import (
    MOTION,
    Tracked,
    Tracker,
    TrackerParams,
    between_updates,
    model_of,
    predict,
    put_at_rest,
)
from core.voltage import AppliedPorts, Gathered


class LightPorts(BlockPorts):
    """Where to take over, the past, and the light."""

    last: float = LAST_PORT
    past: Records[Entry] = PAST_PORT
    light: float = reads("through_wafer.intensity", "1", "light through the wafer")


class SingleBeam(Tracker):
    r"""Displacement from one beam by several extended Kalman filters that know the device and the voltage.

    The light is the same on both sides of each of its extremes, :math:`I(2x_e-x)=I(x)`. So whenever a hypothesis
    passes an extreme, or turns near one, the unit also follows its reflection :math:`(2x_e-x,-\dot x)`, at most ten
    hypotheses in all; only one of the two keeps obeying the equation of motion. The unit puts out the likeliest, by a
    likelihood with a memory of a few periods of the drive. One filter would suffice while the stiffness is known to 30
    %; beyond that it slips, and the reflections bring it back.

    While it runs it costs as much as the rest of the bench together. It begins with the position and the speed that
    one filter finds from the measurements of the last samples.
    The text refers to others for the unit (2.2.3: Dawson 2000, 2002; Wang 2005); this one is the bench's own.
    """

    title = "Single beam, several hypotheses"
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
        """Its assumptions about the shuttle, and its treatment of hypotheses."""

        memory_ms: float = parameter(2.8, "memory of the likelihood", "ms", gt=0, le=1e4)
        reflection_odds: float = parameter(25.0, "logarithm of the odds against a reflection", ge=0, le=100)
        drop: float = parameter(40.0, "log-likelihood below the best at which a hypothesis is dropped", gt=0, le=1e4)
        near_um: float = parameter(0.5, "turns this near an extreme are reflected", "um", ge=0, le=100)

    class Packed(Odds):
        """The odds of the hypotheses, and the model of the shuttle."""

        model: Tracked

    class State(Followed):
        """The hypotheses, whether it has run, the voltage."""

        started: float
        drive: Gathered

    class Ports(LightPorts, AppliedPorts):
        """Reads the light and the voltage; writes the displacement."""

        true: float = TRUE_PORT
        displacement: float = RECOVERED_PORT
        error: float = ERROR_PORT
        active: float = tap("1", "0 while it rests")
        hypotheses: float = tap("1", "hypotheses followed")
        switches: float = tap("1", "how often another hypothesis became the likeliest")
        slips: float = SLIPS_PORT

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the noise of a pair of beams of the same quality; the filter's own error is close to it."""
        return calibrated(context, "through_wafer", ThroughWafer.Params).phase_noise_um

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return the pitch of the grating it looks at."""
        return calibrated(context, "through_wafer", ThroughWafer.Params).pitch_um

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step, with the grating as calibrated."""
        beam = calibrated(context, "through_wafer", ThroughWafer.Params)
        noise = max(beam.noise, 1e-4 * abs(beam.harmonics[0]), 1e-30)
        p = beam.packed(cls.Packed, context)
        p.noise = noise * noise
        p.forgetting = exp(-context.dt_ms / params.memory_ms)
        p.same_x = 0.0125 * beam.pitch_um
        p.same_v = 0.025 * beam.pitch_um * context.device.natural_frequency
        p.model = model_of(params, context)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Whether it has run, the best hypothesis, its changes, and one hypothesis."""
        s = cls.State.zeros()
        put_at_rest(s.hypotheses[0], params, context)
        s.hypotheses[0].used = YES
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Follow every hypothesis and put out the displacement of the likeliest."""
        if between_updates(p.model, s.drive, x):
            return
        first = False
        if s.started == 0.0:
            s.started = 1.0
            first = not catch_up(p.model, s.hypotheses[0], s.drive, x.past, x)
            if first:
                s.hypotheses[0].x = begin_at(x.last)
        z = x.light
        for i in range(MOST):
            hypothesis = s.hypotheses[i]
            if hypothesis.used == YES:
                before = hypothesis.x
                speed = hypothesis.v
                if not first:
                    predict(p.model, hypothesis, s.drive)
                if math.isfinite(z):
                    follow(p, hypothesis, z)
                    turns(p, s, hypothesis, before, speed)
        s.drive.begun = 0.0
        left = sift(p, s)
        displacement = s.hypotheses[int(s.best)].x
        error = displacement - x.true
        x.displacement = displacement
        x.error = error
        x.active = 1.0
        x.hypotheses = left
        x.switches = s.changes
        x.slips = slips(error, 2.0 * math.pi / p.wave)
