"""A controller that is computed outside of the board."""

from __future__ import annotations

from core.block import Block, BlockParams, Equation
from core.control.controller import EngagedPorts, ReferencePorts
from core.ports import reads
from core.record import Record


class ExternalController(Block):
    r"""The voltage comes from outside, :math:`u_i=f(r_i,y_{m,i},y_i,\dots)`: from a function, or from another program.

    It is called once the sample has been measured and answers before the voltage is held, so that its delay equals the
    delay of every other controller. `core.board.hosted` calls it; any other board has no program to call.
    """

    title = "External"
    apart = True
    equations = (Equation("law", r"u_i=f(r_i,y_{m,i},y_i,u_{i-1})"),)

    class Params(BlockParams):
        """Its law is outside."""

    class State(Record):
        """The requested voltage, V."""

        asked: float

    class Ports(ReferencePorts, EngagedPorts):
        """All inputs of a controller, and the voltage it requests."""

        applied: float = reads("drive.voltage", "V", "voltage applied over the sample that ends now")

    @staticmethod
    def step(p: Record, s: State, x: Ports) -> None:
        """Pass on the requested voltage."""
        x.voltage = s.asked
