"""Allan deviation of the rate, as it runs."""

from __future__ import annotations

import math
from typing import Any, ClassVar

from core.block import Block, BlockParams, Context, Equation, parameter
from core.kernel import kernel
from core.ports import BlockPorts, output, reads, tap
from core.record import Record, Records, Vector, several, vector
from core.units import MS_PER_S

LEVELS = 20
"""Octaves of averaging time."""
FIRST = 4
"""Octaves of the first stage: 1, 2, 4 and 8 intervals; every other stage has one, of 8 of its values."""
STAGES = LEVELS - FIRST + 1
RING = 16
"""Values a stage keeps: twice the longest average."""
OCTAVES = tuple(str(2**level) for level in range(LEVELS))


class AllanStage(Record):
    """The last means, the place of the next, how many there are, and the first mean of a pair."""

    ring: Vector = vector(RING)
    place: float
    filled: float
    waits: float
    half: float


@kernel
def push(stage: AllanStage, value: float) -> None:
    """Keep a mean, and forget the oldest."""
    place = int(stage.place)
    stage.ring[place] = value
    stage.place = (place + 1) % RING
    stage.filled = min(stage.filled + 1.0, float(RING))


@kernel
def difference(stage: AllanStage, count: int) -> float:
    """Return the difference of the means of the last ``count`` values and of as many before."""
    place = int(stage.place)
    late = 0.0
    early = 0.0
    for i in range(1, count + 1):
        late += stage.ring[(place - i) % RING]
        early += stage.ring[(place - count - i) % RING]
    return (late - early) / count


class Allan(Block):
    r"""Allan deviation of the estimated rate, one figure for each octave of averaging time; pairs overlap in part.

    .. math:: \sigma^2(\tau)=\frac1{2M}\sum_k\left(\bar\Omega_{k+m}-\bar\Omega_k\right)^2,\quad
        \tau=m\tau_0=2^j\tau_0

    with the M pairs of neighbouring means over m intervals that begin :math:`\max(1,m/8)` intervals apart: all pairs
    that there are up to 8 intervals, and one in m/8 from 16 intervals on. Means of pairs go from stage to stage, so
    that a record of any length takes 17 short rings; all pairs of the longest octave would take a million means. An
    interval in which the rate is not a number is a gap: no average spans it.
    """

    title = "Allan deviation"
    axes: ClassVar[tuple[str, ...]] = ("x", "y")
    equations = (
        Equation(
            "deviation",
            r"\sigma^2(\tau)=\frac{1}{2M}\sum_k\left(\bar\Omega_{k+m}-\bar\Omega_k\right)^2",
            "IEEE Std 952, annex C; all overlapping pairs, as in NIST SP 1065, 5.2.4, up to 8 intervals only",
        ),
    )

    weaknesses = (
        "From 16 intervals on pairs begin an eighth of the averaging time apart, so the deviation differs from that of "
        "all overlapping pairs, by -0.4 to +2.6 % in a record of some hundred intervals.",
    )

    class Params(BlockParams):
        """Interval and start."""

        interval_ms: float = parameter(
            1.0, "shortest averaging time, in whole samples", "ms", equation="deviation", gt=0, le=1e6, live=False
        )
        skip_ms: float = parameter(0.0, "start of the run that is left out", "ms", ge=0, le=1e9)

    class Packed(Record):
        """Samples of an interval, start that is left out."""

        samples: float
        skip_ms: float

    class State(Record):
        """Sum and samples of the interval so far, sums of squared differences and their numbers, stages."""

        sum: float
        samples: float
        squares: Vector = vector(LEVELS)
        averages: Vector = vector(LEVELS)
        stages: Records[AllanStage] = several(STAGES)

    class Ports(BlockPorts):
        """The estimate, and its deviation."""

        estimate: float = reads("@active.rate", "deg/s", "rate as the controller that drives estimates it")
        deviation: Vector = output("deg/s", "Allan deviation over so many intervals", labels=OCTAVES)
        averages: Vector = tap("1", "pairs of means in the deviation over so many intervals", labels=OCTAVES)

    @classmethod
    def samples(cls, params: Any, context: Context) -> int:
        """Return the samples of an interval."""
        return max(1, round(float(params.interval_ms) / context.dt_ms))

    @classmethod
    def taus_s(cls, params: Any, context: Context) -> list[float]:
        """Return the averaging time of every octave, s."""
        interval_s = cls.samples(params, context) * context.dt_ms / MS_PER_S
        return [2**level * interval_s for level in range(LEVELS)]

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the interval."""
        p = cls.Packed.blank()
        p.samples = cls.samples(params, context)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Gather an interval, and hand its mean from stage to stage as far as pairs are complete."""
        if x.tick == 0.0:
            for level in range(LEVELS):
                x.deviation[level] = 0.0
                x.averages[level] = 0.0
        if x.time_ms < p.skip_ms:
            return
        s.sum += x.estimate
        s.samples += 1.0
        if s.samples < p.samples:
            return
        mean = s.sum / s.samples
        s.sum = 0.0
        s.samples = 0.0
        if not math.isfinite(mean):
            for i in range(STAGES):
                s.stages[i].filled = 0.0
                s.stages[i].waits = 0.0
            return
        for i in range(STAGES):
            stage = s.stages[i]
            push(stage, mean)
            for octave in range(0 if i == 0 else FIRST - 1, FIRST):
                count = 1 << octave
                if stage.filled >= 2 * count:
                    level = i + octave
                    step = difference(stage, count)
                    s.squares[level] += step * step
                    s.averages[level] += 1.0
                    x.deviation[level] = math.sqrt(0.5 * s.squares[level] / s.averages[level])
                    x.averages[level] = s.averages[level]
            if stage.waits == 0.0:
                stage.waits = 1.0
                stage.half = mean
                break
            stage.waits = 0.0
            mean = 0.5 * (stage.half + mean)
