"""Drive of an axis: limiter and converter between the controllers and one axis of the plant."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Block, BlockParams, Context, parameter
from core.converter import BITS, Converter, convert, reach, step_of
from core.ports import BlockPorts, output, reads, tap
from core.record import Record


class AxisDrive(Block):
    """Limiter and digital-to-analogue converter of one axis; holds the force for one sample.

    The force comes from the driving controller in the last slot that has an output named after the axis.
    """

    title = "Drive of an axis"
    per_axis = True

    class Params(BlockParams):
        """The output stage, the same for every axis."""

        limit_un: float = parameter(1000.0, "limit to either side", "uN", gt=0, le=1e6)
        quantum_un: float = parameter(0.0, "step of the converter, 0 for none", "uN", ge=0, le=1e4)
        bits: int = BITS
        kind: Literal["held", "analogue"] = parameter(
            "held",
            "held by a converter, or analogue, for controllers that know their force between samples",
            live=False,
        )

    class Packed(Converter):
        """The converter, and whether it passes on how the force moves between samples."""

        analogue: float

    class Ports(BlockPorts):
        """Requested force, applied force."""

        command: float = reads("@command", "uN", "force asked for by the controller that drives the axis")
        command_middle: float = reads("@command_middle", "uN", "the same half a sample later")
        command_end: float = reads("@command_end", "uN", "the same one sample later")
        force: float = output("uN", "applied force")
        middle: float = output("uN", "applied force half a sample later", hidden=True)
        end: float = output("uN", "applied force one sample later", hidden=True)
        saturated: float = tap("1", "1 while more force is asked for than the drive has")

    @classmethod
    def quantum(cls, params: Any) -> float:
        """Return the step of the converter, 0 for none."""
        return step_of(params.quantum_un, params.bits, params.limit_un)

    @classmethod
    def reach(cls, params: Any) -> float:
        """Return the largest force that is put out."""
        return reach(params.limit_un, cls.quantum(params))

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the limit and the step."""
        p = cls.Packed.blank()
        p.limit, p.quantum = cls.reach(params), cls.quantum(params)
        p.analogue = params.kind == "analogue"
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Apply the requested force, as far as the drive can."""
        x.force = convert(p, x.command)
        if p.analogue == 0.0 or (x.command_middle == x.command and x.command_end == x.command):
            x.middle = x.force
            x.end = x.force
        else:
            x.middle = convert(p, x.command_middle)
            x.end = convert(p, x.command_end)
        x.saturated = 1.0 if abs(x.command) > p.limit else 0.0
