"""The displacement of a record as it was measured."""

from __future__ import annotations

from typing import Any

from core.block import Block, BlockParams, Context, parameter
from core.ports import BlockPorts, output, reads
from core.record import Record


class Recorded(Block):
    """Passes on the samples of a record; its noise is the noise that was measured, and is never added."""

    title = "Recorded displacement"
    apart = True
    plants = ("record",)

    class Params(BlockParams):
        """The noise that filters should assume."""

        noise_um: float = parameter(0.01, "standard deviation of the noise in the record", "um", gt=0, le=100)

    class Ports(BlockPorts):
        """The record and the measurement."""

        recorded: float = reads("plant.displacement", "um", "recorded displacement")
        displacement: float = output("um", "measured displacement")

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the noise of a sample."""
        return float(params.noise_um)

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return 0: a record distinguishes all displacements."""
        return 0.0

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Pass on the recorded displacement."""
        x.displacement = x.recorded
