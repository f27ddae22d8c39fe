"""Guard of a record: nothing that is over can be stopped before it does harm."""

from __future__ import annotations

from core.block import Block, BlockParams
from core.ports import BlockPorts, output
from core.record import Record


class RecordGuard(Block):
    """Never trips the board; the end of the record does."""

    title = "Guard of a record"
    apart = True

    class Params(BlockParams):
        """Nothing to choose."""

    class Ports(BlockPorts):
        """The verdict."""

        trip: float = output("1", "0", hidden=True)

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Never trip."""
        x.trip = 0.0
