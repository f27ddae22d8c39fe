"""Sampler of an axis: the anti-alias filter and the uncertain instant of sampling."""

from __future__ import annotations

from typing import Any

from core.block import Block, Context
from core.loop.sampler import PackedSampler, Sampler, SamplerParams, SamplerState, sample
from core.ports import BlockPorts, output, reads


class AxisSampler(Block):
    """Filter and instant of sampling along one axis of the device; all axes have one clock."""

    title = "Filter and sampling of an axis"
    per_axis = True
    equations = Sampler.equations

    class Params(SamplerParams):
        """The stages in front of the converter of a sensor, the same for every axis."""

    class Packed(PackedSampler):
        """The filter and the clock."""

    class State(SamplerState):
        """The filter."""

    class Ports(BlockPorts):
        """The motion along the axis, and the motion as sampled."""

        true: float = reads("plant.{axis}", "um", "true displacement")
        moving: float = reads("plant.{axis}_velocity", "um/ms", "true velocity")
        displacement: float = output("um", "displacement as sampled", hidden=True)
        velocity: float = output("um/ms", "velocity as sampled", hidden=True)

    @classmethod
    def rests(cls, params: Any) -> bool:
        """Say whether a sensor senses the motion as it is."""
        return Sampler.rests(params)

    @classmethod
    def pack(cls, params: Any, context: Context) -> PackedSampler:
        """Pack filter and clock."""
        return Sampler.pack(params, context)

    @staticmethod
    def step(p: PackedSampler, s: SamplerState, x: Ports) -> None:
        """Filter and sample."""
        x.displacement, x.velocity = sample(p, s, x.tick, x.true, x.moving)
