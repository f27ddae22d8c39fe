"""Square wave."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, kernel, parameter
from core.device.ranges import Sized
from core.reference.waveform import FIRST, ReferenceParams, Waveform, playing


@kernel
def square(p: Any, t: float) -> float:
    """High for the duty share of each period, low for the rest."""
    cycles = p[FIRST] * t
    return 1.0 if cycles - math.floor(cycles) < p[FIRST + 1] else -1.0


class Square(Waveform):
    r"""Square wave, :math:`r(t)=r_0\pm A`."""

    title = "Square wave"
    equations = (Equation("reference", r"r(t)=r_0+A\,\mathrm{sgn}\left(d-\mathrm{frac}(ft)\right)"),)

    class Params(ReferenceParams):
        """Parameters of a square wave."""

        frequency_hz: Sized = parameter(200.0, "frequency", "Hz", ge=0, le=1e6)
        duty: float = parameter(0.5, "share of the period that is high", gt=0, le=1)

    @classmethod
    def shape_parameters(cls, params: Any, context: Context) -> list[float]:
        """Cycles per ms and duty."""
        return [params.frequency_hz / 1e3, params.duty]

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        r"""Return the constant and the odd or even harmonics, :math:`a_n=\frac{4}{n\pi}|\sin n\pi d|`."""
        if params.frequency_hz == 0.0:
            return [(0.0, 1.0)]
        harmonics = [(n, 4.0 / (n * math.pi) * abs(math.sin(n * math.pi * params.duty))) for n in range(1, 8)]
        lines = [(n * params.frequency_hz, share) for n, share in harmonics if share > 1e-9]
        return [(0.0, 2.0 * params.duty - 1.0), *lines]

    step = playing(square)
