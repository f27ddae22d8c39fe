"""Drive of a record: it applies the voltage that was measured."""

from __future__ import annotations

from core.block import Block
from core.loop.drive import Drive
from core.ports import BlockPorts, output, reads, tap
from core.record import Record


class RecordDrive(Block):
    """Applies the recorded voltage; laws in shadow know the same limits as with a device."""

    title = "Recorded drive"
    apart = True

    Params = Drive.Params

    class Ports(BlockPorts):
        """Recorded voltage in, the same voltage out."""

        recorded: float = reads("plant.drive", "V", "recorded voltage from this sample on")
        voltage: float = output("V", "applied voltage")
        middle: float = output("V", "applied voltage half a sample later", hidden=True)
        end: float = output("V", "applied voltage one sample later", hidden=True)
        saturated: float = tap("1", "0: nothing asks a record for voltage")

    @staticmethod
    def step(p: Record, s: Record, x: Ports) -> None:
        """Apply the recorded voltage."""
        x.voltage = x.recorded
        x.middle = x.recorded
        x.end = x.recorded
