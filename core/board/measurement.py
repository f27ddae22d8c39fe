"""Measurement: which of the sensors the controllers and diagnosers are given, and what is wrong with it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import TICK, Block, BlockParams, Context, FloatArray, Port
from core.sense.past import ENTRY, KEPT, note
from core.voltage import APPLIED_PORTS

CHOSEN, OFFSET, QUANTUM, HELD, APPLIED = range(5)
MEASURED, PAST = APPLIED + len(APPLIED_PORTS), APPLIED + len(APPLIED_PORTS) + 1
VARIANCE, EVERY = range(2)


def measurement_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Pass on the displacement of the sensor in use, unless the sample was lost."""
    if w[io[HELD]] != 0.0:
        note(w, io, PAST, APPLIED, 0.0, 0.0)
        return
    z = w[io[CHOSEN]]
    if w[io[OFFSET]] != 0.0:
        z += w[io[OFFSET]]
    if w[io[QUANTUM]] != 0.0:
        z = w[io[QUANTUM]] * math.floor(z / w[io[QUANTUM]] + 0.5)
    w[io[MEASURED]] = z
    # a division costs more than the rest of this step, and most sensors run at every tick
    fresh = (p[EVERY] == 1.0 or int(w[TICK]) % int(p[EVERY]) == 0) and math.isfinite(z)
    variance = p[VARIANCE] + w[io[QUANTUM]] * w[io[QUANTUM]] / 12.0
    note(w, io, PAST, APPLIED, z, variance if fresh else 0.0)


class Measurement(Block):
    """Passes on the displacement of the sensor in use; all sensors run, so a change is one index.

    What faults of the measurement do comes in the order of the chain: what is added before the converter, the
    converter, the samples that get lost behind it. The last samples are kept for a sensor that takes over in motion.
    """

    title = "Measurement"
    inputs = (
        Port("chosen", "um", "displacement of the sensor in use", source="@measuring"),
        Port("offset", "um", "added to what is measured", source="effects.sensor_offset"),
        Port("quantum", "um", "step what is measured is rounded to", source="effects.sensor_quantum"),
        Port("held", "1", "not zero while the sample is lost", source="effects.sensor_held"),
        *APPLIED_PORTS,
    )
    outputs = (Port("displacement", "um", "measured displacement"),)
    taps = (
        Port(
            "past",
            "mixed",
            "what was measured over the last samples, with voltage and variance",
            labels=tuple(str(i) for i in range(KEPT * ENTRY)),
            hidden=True,
        ),
    )

    class Params(BlockParams):
        """Nothing to choose but the sensor."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the variance of a sample, not 0 so that it counts as measured, and how often there is one."""
        noise = max(context.sensor_noise_um, 1e-6)
        return np.array([noise * noise, context.sensor_every])

    step = measurement_step
