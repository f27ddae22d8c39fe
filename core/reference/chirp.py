"""Chirp."""

from __future__ import annotations

import math
from typing import Any, Self

from pydantic import model_validator

from core.block import Context, Equation, kernel, parameter
from core.device.ranges import Sized
from core.reference.waveform import FIRST, ReferenceParams, Waveform, playing, sine_of


@kernel
def chirp(p: Any, t: float) -> float:
    """Linear sweep over the duration, then again from the start."""
    sweep = p[FIRST + 2]
    tau = t - sweep * math.floor(t / sweep)
    return sine_of(p[FIRST] * tau + 0.5 * (p[FIRST + 1] - p[FIRST]) * tau * tau / sweep)


class Chirp(Waveform):
    r"""Repeated linear sweep from :math:`f_1` to :math:`f_2` in :math:`T`."""

    title = "Chirp"
    equations = (
        Equation("reference", r"r=r_0+A\sin 2\pi\left(f_1\tau+\frac{f_2-f_1}{2T}\tau^2\right),\ \tau=t \bmod T"),
    )

    class Params(ReferenceParams):
        """Parameters of a sweep."""

        start_hz: Sized = parameter(500.0, "frequency at the start", "Hz", ge=0, le=1e6)
        stop_hz: Sized = parameter(5000.0, "frequency at the end", "Hz", ge=0, le=1e6)
        duration_ms: float = parameter(50.0, "length of a sweep", "ms", gt=0)

        @model_validator(mode="after")
        def _sweeps(self) -> Self:
            if self.start_hz == self.stop_hz:
                raise ValueError("start_hz and stop_hz must differ; use sine for one tone")
            return self

    @classmethod
    def shape_parameters(cls, params: Any, context: Context) -> list[float]:
        """Both frequencies in cycles per ms, and the duration."""
        return [params.start_hz / 1e3, params.stop_hz / 1e3, params.duration_ms]

    step = playing(chirp)
