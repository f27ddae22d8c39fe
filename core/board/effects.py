"""Effect channels: what faults multiply."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, FloatArray, Port


def effects_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Start the tick without any fault."""
    for i in range(int(p[0])):
        w[io[i]] = 1.0


class Effects(Block):
    """The channels through which faults reach the plant, set back to 1 before the faults of each tick."""

    title = "Effect channels"
    outputs = (
        Port("mass_scale", "1", "true mass over nominal"),
        Port("stiffness_scale", "1", "true stiffness over nominal"),
        Port("damping_scale", "1", "true damping over nominal"),
        Port("vacuum", "1", "share of the vacuum that is left", hidden=True),
    )

    class Params(BlockParams):
        """Nothing to choose."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Return the number of channels."""
        return np.array([float(len(cls.outputs))])

    step = effects_step
