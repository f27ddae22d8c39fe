"""Open loop."""

from __future__ import annotations

from core.block import Block, BlockParams, Equation, Stage
from core.control.controller import FeedForwardPorts
from core.record import Record


class OpenLoop(Block):
    r"""No feedback: the reference is the drive, :math:`u=r`."""

    title = "Open loop"
    place = 1
    equations = (Equation("law", r"u=r"),)
    structure = (Stage("Law", "reference", "voltage", ("law",)),)

    class Params(BlockParams):
        """Open loop has no parameters."""

    class Ports(FeedForwardPorts):
        """Ports of a law without feedback."""

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Pass the reference on."""
        x.voltage = x.reference
        x.voltage_middle = x.reference_middle
        x.voltage_end = x.reference_end
