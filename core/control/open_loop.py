"""Open loop."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray
from core.control.controller import INPUTS, OUTPUT, REFERENCE, VOLTAGE


def open_loop_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Pass the reference on."""
    w[io[VOLTAGE]] = w[io[REFERENCE]]


class OpenLoop(Block):
    r"""No feedback: the reference is the drive, :math:`u=r`."""

    title = "Open loop"
    inputs = INPUTS
    outputs = (OUTPUT,)
    equations = (Equation("law", r"u=r"),)

    class Params(BlockParams):
        """Open loop has no parameters."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack nothing."""
        return np.zeros(0)

    step = open_loop_step
