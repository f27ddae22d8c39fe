"""Measurement: which of the sensors the controllers and diagnosers are given, and what is wrong with it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, FloatArray, Port

CHOSEN, OFFSET, QUANTUM, HELD, MEASURED = range(5)


def measurement_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Pass on the displacement of the sensor in use, unless the sample was lost."""
    if w[io[HELD]] != 0.0:
        return
    z = w[io[CHOSEN]]
    if w[io[OFFSET]] != 0.0:
        z += w[io[OFFSET]]
    if w[io[QUANTUM]] != 0.0:
        z = w[io[QUANTUM]] * math.floor(z / w[io[QUANTUM]] + 0.5)
    w[io[MEASURED]] = z


class Measurement(Block):
    """Passes on the displacement of the sensor in use; all sensors run, so a change is one index.

    What faults of the measurement do comes in the order of the chain: what is added before the converter, the
    converter, the samples that get lost behind it.
    """

    title = "Measurement"
    inputs = (
        Port("chosen", "um", "displacement of the sensor in use", source="@measuring"),
        Port("offset", "um", "added to what is measured", source="effects.sensor_offset"),
        Port("quantum", "um", "step what is measured is rounded to", source="effects.sensor_quantum"),
        Port("held", "1", "not zero while the sample is lost", source="effects.sensor_held"),
    )
    outputs = (Port("displacement", "um", "measured displacement"),)

    class Params(BlockParams):
        """Nothing to choose but the sensor."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack nothing."""
        return np.zeros(0)

    step = measurement_step
