"""What every fault shares: severity over time."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

import numpy as np

from core.block import Block, BlockParams, Context, FloatArray, Port, kernel, parameter

KIND, SEVERITY, START, LENGTH, ON = range(5)
STEP, RAMP, INTERMITTENT = 0.0, 1.0, 2.0
KINDS = {"step": STEP, "ramp": RAMP, "intermittent": INTERMITTENT}


class Profile(BlockParams):
    """How the severity comes: at once, as a ramp, or on and off."""

    kind: Literal["step", "ramp", "intermittent"] = parameter("step", "how the severity comes")
    duration_ms: float = parameter(5.0, "length of the ramp", "ms", gt=0, le=1e9)
    period_ms: float = parameter(2.0, "period of an intermittent fault", "ms", gt=0, le=1e9)
    duty: float = parameter(0.5, "share of the period in which an intermittent fault is on", gt=0, le=1)


class FaultParams(BlockParams):
    """A fault as injected; severity 0 is bit for bit no fault."""

    severity: float = parameter(0.0, "severity, a share of the nominal value", "1")
    profile: Profile = parameter(Profile(), "how the severity comes")
    start_tick: int = parameter(0, "tick of the injection", ge=0, live=False)


class Fault(Block):
    """A fault multiplies effect channels, or adds to them; ``shows`` names the part it is seen on."""

    shows: ClassVar[str]
    changes: ClassVar[str]
    suggested: ClassVar[float] = 0.05

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack severity and profile; the interval and its part that is on in whole ticks."""
        profile = params.profile
        length = profile.duration_ms if profile.kind == "ramp" else profile.period_ms
        ticks = max(1.0, round(length / context.dt_ms))
        on = max(1.0, round(profile.duty * ticks))
        return np.array([KINDS[profile.kind], params.severity, float(params.start_tick), ticks, on])


def channel(name: str) -> tuple[Port, ...]:
    """Return the input port of a fault: the effect it multiplies."""
    return (Port("effect", "1", f"effect channel {name}", source=f"effects.{name}"),)


def channels(*names: str) -> tuple[Port, ...]:
    """Return the input ports of a fault with several effects, in their order."""
    return tuple(Port(name, "1", f"effect channel {name}", source=f"effects.{name}") for name in names)


@kernel
def severity_at(p: Any, tick: float) -> float:
    """Severity at a tick."""
    if p[SEVERITY] == 0.0:
        return 0.0
    since = tick - p[START]
    if p[KIND] == RAMP:
        return float(p[SEVERITY] * min(1.0, since / p[LENGTH]))
    if p[KIND] == INTERMITTENT:
        return float(p[SEVERITY]) if since - p[LENGTH] * math.floor(since / p[LENGTH]) < p[ON] else 0.0
    return float(p[SEVERITY])


def scale_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Multiply the effect channel by one plus the severity."""
    severity = severity_at(p, w[0])
    w[io[1]] = severity
    if severity != 0.0:
        w[io[0]] *= 1.0 + severity
