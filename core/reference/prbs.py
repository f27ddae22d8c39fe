"""Pseudo-random binary sequence."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, kernel, parameter
from core.noise import key, uniform
from core.reference.waveform import FIRST, ReferenceParams, Waveform, playing


@kernel
def chips(p: Any, t: float) -> float:
    """Sign of the chip that is on now."""
    return 1.0 if uniform(p[FIRST + 1], math.floor(t * p[FIRST])) < 0.5 else -1.0


class Prbs(Waveform):
    r"""Random signs held for one chip each, :math:`r(t)=r_0\pm A`; the same seed gives the same sequence."""

    title = "Pseudo-random binary sequence"
    equations = (Equation("reference", r"r(t)=r_0+A\,b_{\lfloor f_c t\rfloor},\quad b_i\in\{-1,1\}"),)

    class Params(ReferenceParams):
        """Parameters of a binary sequence."""

        chip_rate_hz: float = parameter(10000.0, "chips per second", "Hz", gt=0, le=1e6)

    @classmethod
    def shape_parameters(cls, params: Any, context: Context) -> list[float]:
        """Chips per ms and the key of the sequence."""
        return [params.chip_rate_hz / 1e3, key(context.seed, "reference.prbs")]

    step = playing(chips)
