"""Drive: limiter and converter between the controller that drives and the plant."""

from __future__ import annotations

from typing import Any, Literal

from core.block import Block, BlockParams, Context, parameter
from core.converter import BITS, Converter, convert, reach, step_of
from core.elementary import floor
from core.noise import uniform
from core.ports import BlockPorts, output, reads, tap
from core.record import Record, stream


class Drive(Block):
    """Limiter and digital-to-analogue converter; holds the voltage for one sample."""

    title = "Drive"

    class Params(BlockParams):
        """The output stage."""

        limit_v: float = parameter(30.0, "limit to either side", "V", gt=0, le=1000)
        quantum_v: float = parameter(0.0, "step of the converter, 0 for none", "V", ge=0, le=100)
        bits: int = BITS
        dither_v: float = parameter(
            0.0,
            "random signs added to the controller's voltage, so that a constant drive carries information",
            "V",
            ge=0,
            le=100,
        )
        dither_rate_hz: float = parameter(10_000.0, "signs per second", "Hz", gt=0, le=1e6)
        kind: Literal["held", "analogue"] = parameter(
            "held", "held by a converter, or an analogue generator (open loop only)", live=False
        )

    class Packed(Converter):
        """The converter, size and rate per ms of the dither, its key."""

        dither_v: float
        dither_per_ms: float
        dither_key: float = stream("drive.dither")

    class Ports(BlockPorts):
        """Requested voltage, applied voltage."""

        command: float = reads("@active", "V", "voltage asked for by the controller that drives")
        command_middle: float = reads("@active_middle", "V", "the same half a sample later")
        command_end: float = reads("@active_end", "V", "the same one sample later")
        voltage: float = output("V", "applied voltage")
        middle: float = output("V", "applied voltage half a sample later", hidden=True)
        end: float = output("V", "applied voltage one sample later", hidden=True)
        saturated: float = tap("1", "1 while more voltage is asked for than the drive has")

    @classmethod
    def quantum(cls, params: Any) -> float:
        """Return the step of the converter, 0 for none."""
        return step_of(params.quantum_v, params.bits, params.limit_v)

    @classmethod
    def reach(cls, params: Any) -> float:
        """Return the largest voltage that is put out."""
        return reach(params.limit_v, cls.quantum(params))

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        p.limit, p.quantum = cls.reach(params), cls.quantum(params)
        p.dither_per_ms = params.dither_rate_hz / 1e3
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Apply the requested voltage, as far as the drive can."""
        dither = 0.0
        if p.dither_v > 0.0:
            dither = p.dither_v if uniform(p.dither_key, floor(x.time_ms * p.dither_per_ms)) < 0.5 else -p.dither_v
        u = x.command + dither
        x.voltage = convert(p, u)
        if x.command_middle == x.command and x.command_end == x.command:
            x.middle = x.voltage
            x.end = x.voltage
        else:
            x.middle = convert(p, x.command_middle + dither)
            x.end = convert(p, x.command_end + dither)
        x.saturated = 1.0 if abs(u) > p.limit else 0.0
