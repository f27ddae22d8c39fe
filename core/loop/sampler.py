"""Sampler: the anti-alias filter and the uncertain instant of sampling, between the device and its sensor."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, parameter
from core.kernel import kernel
from core.lag import moments_of_decay
from core.noise import normal
from core.ports import BlockPorts, output, reads
from core.record import Record, stream


class SamplerParams(BlockParams):
    """The stages in front of the converter of a sensor."""

    antialias_khz: float = parameter(0.0, "corner of the anti-alias filter, 0 for none", "kHz", ge=0, le=1e5)
    jitter_us: float = parameter(0.0, "standard deviation of the instant of sampling", "us", ge=0, le=1e4)


class PackedSampler(Record):
    """Interval, standard deviation of the instant and its stream, the filter over an interval."""

    dt_ms: float
    jitter_ms: float
    key: float = stream("board.sampler")
    per_interval: float
    decay: float
    end: float
    slope: float
    bend: float
    twist: float


class SamplerState(Record):
    """Whether it has run, the motion at the last tick, the filtered displacement, the last velocity passed on."""

    begun: float
    displacement: float
    velocity: float
    filtered: float
    rate: float


@kernel
def sample(p: PackedSampler, s: SamplerState, tick: float, x: float, v: float) -> tuple[float, float]:
    r"""Return displacement and velocity as sampled.

    Between two ticks the displacement is the cubic through both motions. The filter is exact for it, and the filtered
    velocity is its rate.
    """
    h = p.dt_ms
    filtered = x
    rate = v
    if s.begun == 0.0:
        s.begun = 1.0
        s.displacement, s.velocity, s.filtered, s.rate = x, v, x, v
    if p.per_interval > 0.0:
        fell = s.displacement - x
        bend = 3.0 * fell + h * (2.0 * v + s.velocity)
        twist = -2.0 * fell - h * (v + s.velocity)
        filtered = p.decay * s.filtered + p.end * x - p.slope * h * v + p.bend * bend + p.twist * twist
        rate = p.per_interval / h * (x - filtered)
    s.displacement, s.velocity, s.filtered = x, v, filtered
    change = (rate - s.rate) / h
    s.rate = rate
    if p.jitter_ms > 0.0:
        late = p.jitter_ms * normal(p.key, tick)
        filtered += late * rate
        rate += late * change
    return filtered, rate


class Sampler(Block):
    r"""Filter and instant of sampling: a sensor senses the motion of the device behind both.

    The filter has one pole, :math:`\dot y=\omega_c(x-y)`. It is in front of the sensor, whose noise is given as the
    noise of a sample, behind the filter. All sensors share one clock, so that all of them sample too late by the same
    time :math:`\delta`: the reading is off by :math:`\delta\dot y`, and noise of jitter is slope times jitter.
    A stage of 0 passes on the motion as it is; the block is left out when both are 0.
    """

    title = "Filter and sampling"
    equations = (
        Equation("filter", r"\dot y=\omega_c\,(x-y)"),
        Equation("sample", r"y_i=y(t_i)+\delta_i\,\dot y(t_i),\quad\delta_i\sim N(0,\sigma_t^2)"),
    )

    class Params(SamplerParams):
        """The stages in front of the converter of a sensor."""

    class Packed(PackedSampler):
        """The filter and the clock."""

    class State(SamplerState):
        """The filter."""

    class Ports(BlockPorts):
        """The motion, and the motion as sampled."""

        true: float = reads("plant.displacement", "um", "true displacement")
        moving: float = reads("plant.velocity", "um/ms", "true velocity")
        displacement: float = output("um", "displacement as sampled", hidden=True)
        velocity: float = output("um/ms", "velocity as sampled", hidden=True)

    @classmethod
    def rests(cls, params: Any) -> bool:
        """Say whether a sensor senses the motion as it is."""
        return bool(params.antialias_khz == 0.0 and params.jitter_us == 0.0)

    @classmethod
    def pack(cls, params: Any, context: Context) -> PackedSampler:
        """Pack filter and clock."""
        p = cls.Packed.blank()
        share = 2.0 * math.pi * params.antialias_khz * context.dt_ms
        p.dt_ms, p.jitter_ms = context.dt_ms, 1e-3 * params.jitter_us
        *moments, p.decay = moments_of_decay(share)
        p.per_interval = share
        p.end, p.slope, p.bend, p.twist = (share * moment for moment in moments)
        return p

    @staticmethod
    def step(p: PackedSampler, s: SamplerState, x: Ports) -> None:
        """Filter and sample."""
        x.displacement, x.velocity = sample(p, s, x.tick, x.true, x.moving)
