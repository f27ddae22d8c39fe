"""A controller that is computed outside of the board."""

from __future__ import annotations

from core.block import Block, BlockParams, Equation
from core.control.controller import EngagedPorts, ReferencePorts
from core.ports import reads
from core.record import Record


class External(Block):
    r"""The voltage comes from outside, :math:`u_i=f(r_i,y_{m,i},y_i,\dots)`: from a function, or from another program.

    It is asked once the sample has been measured and answers before the voltage is held, so that its delay is that of
    every other controller. `core.board.hosted` asks; on any other board there is nobody to ask.
    """

    title = "External"
    apart = True
    equations = (Equation("law", r"u_i=f(r_i,y_{m,i},y_i,u_{i-1})"),)

    class Params(BlockParams):
        """What it does is decided outside."""

    class State(Record):
        """The voltage that was asked for, V."""

        asked: float

    class Ports(ReferencePorts, EngagedPorts):
        """All that a controller may read, and the voltage it asks for."""

        applied: float = reads("drive.voltage", "V", "voltage applied over the sample that ends now")

    @staticmethod
    def step(p: Record, s: State, x: Ports) -> None:
        """Pass on what was asked for."""
        x.voltage = s.asked
