"""Chirp."""

from __future__ import annotations

from typing import Any, Self

from pydantic import model_validator

from core.block import Context, Equation, parameter
from core.device.ranges import Sized
from core.elementary import floor, sin_of_turns
from core.kernel import kernel
from core.reference.waveform import ReferenceParams, Waveform


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

    class Packed(Waveform.Packed):
        """Both frequencies in cycles per ms, and the duration."""

        start_per_ms: float
        stop_per_ms: float
        duration_ms: float

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the frequencies."""
        p: Chirp.Packed = super().pack(params, context)
        p.start_per_ms, p.stop_per_ms = params.start_hz / 1e3, params.stop_hz / 1e3
        return p

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """Linear sweep over the duration, then again from the start."""
        f1 = p.start_per_ms
        sweep = p.duration_ms
        tau = t - sweep * floor(t / sweep)
        return sin_of_turns(f1 * tau + 0.5 * (p.stop_per_ms - f1) * tau * tau / sweep)
