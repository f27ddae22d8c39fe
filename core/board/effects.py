"""Effect channels: what faults multiply."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, FloatArray, Port

STIFFNESS_IN, DAMPING_IN, MASS, STIFFNESS, DAMPING, VACUUM = range(6)


def effects_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Start the tick without any fault."""
    w[io[MASS]] = 1.0
    w[io[STIFFNESS]] = w[io[STIFFNESS_IN]]
    w[io[DAMPING]] = w[io[DAMPING_IN]]
    w[io[VACUUM]] = 1.0


class Effects(Block):
    """The channels through which faults reach the plant, set back before the faults of each tick.

    They start from what the environment makes of the device, which is 1 at 300 K and 1 atm.
    """

    title = "Effect channels"
    inputs = (
        Port("stiffness", "1", "stiffness over nominal in this environment", source="environment.stiffness_scale"),
        Port("damping", "1", "damping over nominal in this environment", source="environment.damping_scale"),
    )
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
        """Pack nothing."""
        return np.zeros(0)

    step = effects_step
