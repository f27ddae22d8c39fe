"""Performance regions: how far the shuttle is from where a healthy one would be."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.device.oscillator import transition
from core.diagnose import window
from core.diagnose.hypothesis import lacking

PHI11, PHI12, PHI21, PHI22, STATIC, EVERY, WINDOW, DEGRADED_AT, UNACCEPTABLE_AT, DANGER_AT, DANGER_UM = range(11)
STARTED, LAST_CHARGE, X, V, ERROR, POWER, SAMPLES = range(7)
MEASURED, MIDDLE, CHARGE, REGION, LOSS = range(5)
REQUIRED, DEGRADED, UNACCEPTABLE, DANGER = range(4)
REGIONS = ("required performance", "degraded performance", "unacceptable performance", "danger")


def regions_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance the healthy device, compare over a period, say where that is."""
    y = w[io[MEASURED]]
    u = w[io[MIDDLE]] if p[EVERY] == 1.0 else (w[io[CHARGE]] - s[LAST_CHARGE]) / p[EVERY]
    s[LAST_CHARGE] = w[io[CHARGE]]
    if s[STARTED] != 0.0:
        rest = p[STATIC] * u
        x = s[X] - rest
        v = s[V]
        s[X] = settled(p[PHI11] * x + p[PHI12] * v + rest)
        s[V] = settled(p[PHI21] * x + p[PHI22] * v)
    else:
        s[STARTED] = 1.0
        w[io[REGION]] = 0.0
        w[io[LOSS]] = 0.0
    if not math.isfinite(y):
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

    title = "Performance regions"
    inputs = (
        Port("measured", "um", "measured displacement", source="sensor.displacement"),
        Port("middle", "V", "voltage applied in the middle of the sample that ends now", source="drive.middle"),
        Port("charge", "V", "running sum of the voltage in the middle of every sample", source="drive.charge"),
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
        phi = transition(device.mass, device.damping, device.stiffness, context.dt_ms)
        period = 1e3 / (window.tone_hz(params, context) * context.dt_ms)
        limits = [params.degraded_above, params.unacceptable_above, params.danger_above, params.danger_um]
        samples = float(params.window or max(2, round(period)))
        return np.array([*phi, device.static_gain, context.every, samples, *limits])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """At rest, nothing compared."""
        return np.zeros(7)

    step = regions_step
