"""Base of the faults: severity over time."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, Protocol

from core.block import Block, BlockParams, Context, parameter
from core.elementary import floor
from core.kernel import kernel
from core.ports import output, reads
from core.record import Record

STEP, RAMP, INTERMITTENT = 0.0, 1.0, 2.0
KINDS = {"step": STEP, "ramp": RAMP, "intermittent": INTERMITTENT}


class Profile(BlockParams):
    """How the severity comes: at once, as a ramp, or on and off."""

    kind: Literal["step", "ramp", "intermittent"] = parameter("step", "how the severity comes")
    duration_ms: float = parameter(5.0, "length of the ramp", "ms", gt=0, le=1e9)
    period_ms: float = parameter(2.0, "period of an intermittent fault", "ms", gt=0, le=1e9)
    duty: float = parameter(0.5, "share of the period in which an intermittent fault is on", gt=0, le=1)


class FaultParams(BlockParams):
    """An injected fault; with severity 0 the results are bit for bit those without the fault."""

    severity: float = parameter(0.0, "severity, a share of the nominal value", "1")
    profile: Profile = parameter(Profile(), "how the severity comes")
    start_tick: int = parameter(0, "tick of the injection", ge=0, live=False)


class PackedFault(Record):
    """Profile, severity, tick of the injection, ticks of the ramp or the period, ticks of it that are on."""

    kind: float
    severity: float
    start_tick: float
    length: float
    on: float


@kernel
def severity_now(p: PackedFault, tick: float) -> float:
    """Return the severity at a tick."""
    if p.severity == 0.0:
        return 0.0
    since = tick - p.start_tick
    if p.kind == RAMP:
        return float(p.severity * min(1.0, since / p.length))
    if p.kind == INTERMITTENT:
        return float(p.severity) if since - p.length * floor(since / p.length) < p.on else 0.0
    return float(p.severity)


def effect(channel: str) -> Any:
    """Declare the effect channel a fault multiplies, or adds to."""
    return reads(f"effects.{channel}", "1", f"effect channel {channel}")


def severity(unit: str, meaning: str) -> Any:
    """Declare the output of the present severity."""
    return output(unit, meaning)


class Fault(Block):
    """A fault, which multiplies effect channels or adds to them; ``shows`` names the part it is seen on."""

    suggested = 0.05

    @classmethod
    def rests(cls, params: Any) -> bool:
        """Say whether the fault is absent."""
        return bool(params.severity == 0.0)

    Packed: ClassVar[type[Record]] = PackedFault

    @classmethod
    def pack(cls, params: Any, context: Context) -> Any:
        """Pack severity and profile; the period and its active part are in whole ticks."""
        profile = params.profile
        length = profile.duration_ms if profile.kind == "ramp" else profile.period_ms
        ticks = max(1.0, round(length / context.dt_ms))
        on = max(1.0, round(profile.duty * ticks))
        p: Any = cls.Packed.blank()
        p.kind, p.length, p.on = KINDS[profile.kind], ticks, on
        return p


class Scales(Protocol):
    """Ports of a fault that scales one channel."""

    tick: float
    effect: float
    severity: float


class ScaleFault(Fault):
    """A fault that multiplies one effect channel by one plus the severity."""

    @staticmethod
    def step(p: PackedFault, s: Record, x: Scales) -> None:
        """Multiply the effect channel by one plus the severity."""
        now = severity_now(p, x.tick)
        x.severity = now
        if now != 0.0:
            x.effect *= 1.0 + now
