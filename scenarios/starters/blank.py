"""Three lines that run: replace them by your own law."""

from __future__ import annotations

from core.block import Block, BlockParams
from core.control.controller import ControllerPorts
from core.record import Record


class MyController(Block):
    """Proportional control, added to the reference."""

    title = "My controller"

    class Params(BlockParams):
        """No parameters yet."""

    class Ports(ControllerPorts):
        """The ports of every controller."""

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Compute one sample: displacements in um, the voltage in V."""
        error = x.model - x.measured
        correction = -2.0 * error
        x.voltage = x.reference + correction
