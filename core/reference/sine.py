"""Sine."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, kernel, parameter
from core.device.ranges import Sized
from core.reference.waveform import FIRST, ReferenceParams, Waveform, line, playing, sine_of


@kernel
def sine(p: Any, t: float) -> float:
    """Sine of frequency and phase."""
    return sine_of(p[FIRST] * t + p[FIRST + 1])


class Sine(Waveform):
    r"""One tone, :math:`r(t)=r_0+A\sin(2\pi f t+\varphi)`."""

    title = "Sine"
    equations = (Equation("reference", r"r(t)=r_0+A\sin(2\pi f t+\varphi)"),)

    class Params(ReferenceParams):
        """Parameters of one tone."""

        frequency_hz: Sized = parameter(1000.0, "frequency", "Hz", ge=0, le=1e6)
        phase_deg: float = parameter(0.0, "phase at t = 0", "deg")

    @classmethod
    def shape_parameters(cls, params: Any, context: Context) -> list[float]:
        """Cycles per ms and cycles at the start."""
        return [params.frequency_hz / 1e3, params.phase_deg / 360.0]

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        """One line."""
        return [line(params.frequency_hz, params.phase_deg)]

    step = playing(sine)
