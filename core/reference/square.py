"""Square wave."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, parameter
from core.device.ranges import Sized
from core.elementary import floor, sin
from core.kernel import kernel
from core.reference.waveform import ReferenceParams, Waveform


class Square(Waveform):
    r"""Square wave, :math:`r(t)=r_0\pm A`."""

    title = "Square wave"
    equations = (Equation("reference", r"r(t)=r_0+A\,\mathrm{sgn}\left(d-\mathrm{frac}(ft)\right)"),)

    class Params(ReferenceParams):
        """Parameters of a square wave."""

        frequency_hz: Sized = parameter(200.0, "frequency", "Hz", ge=0, le=1e6)
        duty: float = parameter(0.5, "share of the period that is high", gt=0, le=1)

    class Packed(Waveform.Packed):
        """Cycles per ms and duty."""

        frequency_per_ms: float
        duty: float

    @classmethod
    def tone_hz(cls, params: Any) -> float:
        """Return its frequency in Hz."""
        return float(params.frequency_hz)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the frequency."""
        p: Square.Packed = super().pack(params, context)
        p.frequency_per_ms = params.frequency_hz / 1e3
        return p

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        r"""Return the constant and the odd or even harmonics, :math:`a_n=\frac{4}{n\pi}|\sin n\pi d|`."""
        if params.frequency_hz == 0.0:
            return [(0.0, 1.0)]
        harmonics = [(n, 4.0 / (n * math.pi) * abs(sin(n * math.pi * params.duty))) for n in range(1, 8)]
        lines = [(n * params.frequency_hz, share) for n, share in harmonics if share > 1e-9]
        return [(0.0, 2.0 * params.duty - 1.0), *lines]

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """High for the duty share of each period, low for the rest."""
        cycles = p.frequency_per_ms * t
        return 1.0 if cycles - floor(cycles) < p.duty else -1.0
