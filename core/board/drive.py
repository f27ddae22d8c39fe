"""Drive: limiter and converter between the controller that drives and the plant."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from core.block import TIME_MS, Block, BlockParams, Context, FloatArray, Port, kernel, parameter
from core.noise import key, uniform

LIMIT, QUANTUM, DITHER, CHIPS, KEY = range(5)
COMMAND, MIDDLE_IN, END_IN, VOLTAGE, MIDDLE, END, SATURATED = range(7)


@kernel
def convert(p: Any, u: float) -> float:
    """Clip to the limit and round to the converter's step; nothing comes out for what is not a number."""
    if not math.isfinite(u):
        return 0.0
    u = min(max(u, -p[LIMIT]), p[LIMIT])
    if p[QUANTUM] > 0.0:
        u = p[QUANTUM] * math.floor(u / p[QUANTUM] + 0.5)
    return u


def drive_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Apply the voltage asked for, as far as the drive can."""
    dither = 0.0
    if p[DITHER] > 0.0:
        dither = p[DITHER] if uniform(p[KEY], math.floor(w[TIME_MS] * p[CHIPS])) < 0.5 else -p[DITHER]
    u = w[io[COMMAND]] + dither
    w[io[VOLTAGE]] = convert(p, u)
    if w[io[MIDDLE_IN]] == w[io[COMMAND]] and w[io[END_IN]] == w[io[COMMAND]]:
        w[io[MIDDLE]] = w[io[VOLTAGE]]
        w[io[END]] = w[io[VOLTAGE]]
    else:
        w[io[MIDDLE]] = convert(p, w[io[MIDDLE_IN]] + dither)
        w[io[END]] = convert(p, w[io[END_IN]] + dither)
    w[io[SATURATED]] = 1.0 if abs(u) > p[LIMIT] else 0.0


class Drive(Block):
    """Limiter and digital-to-analogue converter; holds the voltage for one sample."""

    title = "Drive"
    inputs = (
        Port("command", "V", "voltage asked for by the controller that drives", source="@active"),
        Port("command_middle", "V", "the same half a sample later", source="@active_middle"),
        Port("command_end", "V", "the same one sample later", source="@active_end"),
    )
    outputs = (
        Port("voltage", "V", "applied voltage"),
        Port("middle", "V", "applied voltage half a sample later", hidden=True),
        Port("end", "V", "applied voltage one sample later", hidden=True),
    )
    taps = (Port("saturated", "1", "1 while more voltage is asked for than the drive has"),)

    class Params(BlockParams):
        """The output stage."""

        limit_v: float = parameter(30.0, "limit to either side", "V", gt=0, le=1000)
        quantum_v: float = parameter(0.0, "step of the converter, 0 for none", "V", ge=0, le=100)
        dither_v: float = parameter(
            0.0,
            "random signs added to what the controller asks for, so that a constant drive tells something",
            "V",
            ge=0,
            le=100,
        )
        dither_rate_hz: float = parameter(10_000.0, "signs per second", "Hz", gt=0, le=1e6)
        kind: Literal["held", "analogue"] = parameter(
            "held", "held by a converter, or an analogue generator (open loop only)", live=False
        )

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        dither = [params.dither_v, params.dither_rate_hz / 1e3, key(context.seed, "drive.dither")]
        return np.array([params.limit_v, params.quantum_v, *dither])

    step = drive_step
