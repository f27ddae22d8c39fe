"""Measurement: which of the sensors the controllers and diagnosers are given."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, FloatArray, Port


def measurement_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Pass on the displacement of the sensor in use."""
    w[io[1]] = w[io[0]]


class Measurement(Block):
    """Passes on the displacement of the sensor in use; all sensors run, so a change is one index."""

    title = "Measurement"
    inputs = (Port("chosen", "um", "displacement of the sensor in use", source="@measuring"),)
    outputs = (Port("displacement", "um", "measured displacement"),)

    class Params(BlockParams):
        """Nothing to choose but the sensor."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack nothing."""
        return np.zeros(0)

    step = measurement_step
