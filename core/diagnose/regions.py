"""Performance regions, by the distance of the shuttle from the motion of a healthy one."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Oscillator, Stage, parameter
from core.diagnose import window
from core.diagnose.hypothesis import lacking
from core.kernel import flush_tiny
from core.ports import output
from core.record import Record
from core.voltage import ObservedPorts, Tick, moves, observed, tick_of

REQUIRED, DEGRADED, UNACCEPTABLE, DANGER = 0.0, 1.0, 2.0, 3.0
REGIONS = ("required performance", "degraded performance", "unacceptable performance", "danger")


class Regions(Block):
    r"""Required, degraded or unacceptable performance, or danger, by the distance from the healthy motion.

    .. math:: J=\frac{\mathrm{rms}(y-y_0)}{\mathrm{rms}(y_0)}\ \text{over a period of the drive}

    The healthy motion is the motion of the nominal device under the applied voltage. The text gives the regions and no
    figures; the limits are this bench's own. Beyond the largest safe displacement there is danger at once.
    """

    every_tick = True
    title = "Performance regions"
    equations = (Equation("loss", r"J=\mathrm{rms}(y-y_0)/\mathrm{rms}(y_0)", "5.1.5"),)
    structure = (
        Stage("Healthy device", "applied", "x"),
        Stage("Sums over a period", "measured x", "error power"),
        Stage("Loss", "error power", "loss", ("loss",)),
        Stage("Region", "loss measured", "region"),
    )

    class Params(BlockParams):
        """Limits of the regions."""

        degraded_above: float = parameter(0.05, "loss at which performance is degraded", equation="5.1.5", gt=0, le=10)
        unacceptable_above: float = parameter(
            0.25, "loss at which performance is unacceptable", equation="5.1.5", gt=0, le=10
        )
        danger_above: float = parameter(0.60, "loss at which there is danger", equation="5.1.5", gt=0, le=100)
        danger_um: float = parameter(4.5, "displacement beyond which there is danger", "um", gt=0, le=1000)
        window: int | None = parameter(
            None, "samples of a comparison; a period of the tone unless given", ge=2, le=1_000_000
        )
        tone_hz: float | None = parameter(None, "tone; the reference's unless given", "Hz", gt=0, le=1e6)

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass or spring."""
        return lacking(device)

    class Packed(Record):
        """The healthy device over a tick, its static gain, ticks between two samples, samples of a window, limits."""

        tick: Tick
        static_gain: float
        every: float
        window: float
        degraded_above: float
        unacceptable_above: float
        danger_above: float
        danger_um: float

    class State(Record):
        """Whether it has run, the healthy motion; sums of squares of the error and of that motion, and their count."""

        started: float
        x: float
        v: float
        error: float
        power: float
        samples: float

    class Ports(ObservedPorts):
        """The region, and the loss of performance."""

        region: float = output("1", "0 required, 1 degraded, 2 unacceptable, 3 danger")
        loss: float = output("1", "rms distance from the healthy motion over its rms")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        device = context.device
        period = 1e3 / (window.tone_hz(params, context) * context.dt_ms)
        p = cls.Packed.blank()
        p.tick = tick_of(device, device.force, context.dt_ms / context.every, context.analogue)
        p.static_gain = device.static_gain
        p.every = context.every
        p.window = params.window or max(2, round(period))
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Advance the healthy device over a tick, compare over a period, decide the region."""
        y = observed(x)
        if s.started != 0.0:
            u, middle, end = moves(x)
            rest = p.static_gain * u
            free = s.x - rest
            v = s.v
            more_x = p.tick.middle1 * middle + p.tick.end1 * end
            more_v = p.tick.middle2 * middle + p.tick.end2 * end
            s.x = flush_tiny(p.tick.phi11 * free + p.tick.phi12 * v + rest + more_x)
            s.v = flush_tiny(p.tick.phi21 * free + p.tick.phi22 * v + more_v)
        else:
            s.started = 1.0
            x.region = REQUIRED
            x.loss = 0.0
        if not math.isfinite(y) or (p.every != 1.0 and int(x.tick) % int(p.every) != 0):
            return
        error = y - s.x
        s.error += error * error
        s.power += s.x * s.x
        s.samples += 1.0
        if s.samples >= p.window:
            loss = math.sqrt(s.error / s.power) if s.power > 0.0 else 0.0
            s.error = 0.0
            s.power = 0.0
            s.samples = 0.0
            x.loss = loss
            region = REQUIRED
            if loss >= p.degraded_above:
                region = DEGRADED
            if loss >= p.unacceptable_above:
                region = UNACCEPTABLE
            if loss >= p.danger_above:
                region = DANGER
            x.region = region
        if abs(y) > p.danger_um:
            x.region = DANGER
