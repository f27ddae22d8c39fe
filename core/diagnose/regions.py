"""Performance regions: how far the shuttle is from where a healthy one would be."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.diagnose import window
from core.diagnose.hypothesis import lacking
from core.voltage import (
    APPLIED_PORTS,
    END1,
    END2,
    MIDDLE1,
    MIDDLE2,
    PHI11,
    PHI12,
    PHI21,
    PHI22,
    TICK_SIZE,
    moved,
    pack_tick,
)

STATIC, EVERY, WINDOW, DEGRADED_AT, UNACCEPTABLE_AT, DANGER_AT, DANGER_UM = range(TICK_SIZE, TICK_SIZE + 7)
STARTED, X, V, ERROR, POWER, SAMPLES = range(6)
MEASURED, APPLIED, REGION, LOSS = 0, 1, 1 + len(APPLIED_PORTS), 2 + len(APPLIED_PORTS)
REQUIRED, DEGRADED, UNACCEPTABLE, DANGER = range(4)
REGIONS = ("required performance", "degraded performance", "unacceptable performance", "danger")


def regions_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance the healthy device over a tick, compare over a period, say where that is."""
    y = w[io[MEASURED]]
    if s[STARTED] != 0.0:
        u, middle, end = moved(w, io, APPLIED)
        rest = p[STATIC] * u
        x = s[X] - rest
        v = s[V]
        more_x = p[MIDDLE1] * middle + p[END1] * end
        more_v = p[MIDDLE2] * middle + p[END2] * end
        s[X] = settled(p[PHI11] * x + p[PHI12] * v + rest + more_x)
        s[V] = settled(p[PHI21] * x + p[PHI22] * v + more_v)
    else:
        s[STARTED] = 1.0
        w[io[REGION]] = 0.0
        w[io[LOSS]] = 0.0
    if not math.isfinite(y) or (p[EVERY] != 1.0 and w[TICK] % p[EVERY] != 0.0):
        return
    error = y - s[X]
    s[ERROR] += error * error
    s[POWER] += s[X] * s[X]
    s[SAMPLES] += 1.0
    if s[SAMPLES] >= p[WINDOW]:
        loss = math.sqrt(s[ERROR] / s[POWER]) if s[POWER] > 0.0 else 0.0
        s[ERROR] = 0.0
        s[POWER] = 0.0
        s[SAMPLES] = 0.0
        w[io[LOSS]] = loss
        region = 0.0
        for i in range(3):
            if loss >= p[DEGRADED_AT + i]:
                region = 1.0 + i
        w[io[REGION]] = region
    if abs(y) > p[DANGER_UM]:
        w[io[REGION]] = 3.0


class Regions(Block):
    r"""Required, degraded or unacceptable performance, or danger, by the distance from the healthy motion.

    .. math:: J=\frac{\mathrm{rms}(y-y_0)}{\mathrm{rms}(y_0)}\ \text{over a period of the drive}

    The healthy motion is that of the nominal device under the voltage applied. The text gives the regions and no
    figures; the limits are this bench's own. Beyond the largest safe displacement there is danger at once.
    """

    every_tick = True
    title = "Performance regions"
    inputs = (
        Port("measured", "um", "measured displacement", source="sensor.displacement"),
        *APPLIED_PORTS,
    )
    outputs = (
        Port("region", "1", "0 required, 1 degraded, 2 unacceptable, 3 danger"),
        Port("loss", "1", "rms distance from the healthy motion over its rms"),
    )
    equations = (Equation("loss", r"J=\mathrm{rms}(y-y_0)/\mathrm{rms}(y_0)", "5.1.5"),)

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
        tone_hz: float | None = parameter(None, "tone; that of the reference unless given", "Hz", gt=0, le=1e6)

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass or spring."""
        return lacking(device)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        device = context.device
        tick = pack_tick(device, device.force, context.dt_ms / context.every, context.analogue)
        period = 1e3 / (window.tone_hz(params, context) * context.dt_ms)
        limits = [params.degraded_above, params.unacceptable_above, params.danger_above, params.danger_um]
        samples = float(params.window or max(2, round(period)))
        return np.array([*tick, device.static_gain, context.every, samples, *limits])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """At rest, nothing compared."""
        return np.zeros(6)

    step = regions_step
