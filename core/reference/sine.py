"""Sine."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, parameter
from core.device.ranges import Sized
from core.elementary import sin_of_turns
from core.kernel import kernel
from core.reference.waveform import ReferenceParams, Waveform, line


class Sine(Waveform):
    r"""One tone, :math:`r(t)=r_0+A\sin(2\pi f t+\varphi)`."""

    title = "Sine"
    equations = (Equation("reference", r"r(t)=r_0+A\sin(2\pi f t+\varphi)"),)

    class Params(ReferenceParams):
        """Parameters of one tone."""

        frequency_hz: Sized = parameter(1000.0, "frequency", "Hz", ge=0, le=1e6)
        phase_deg: float = parameter(0.0, "phase at t = 0", "deg")

    class Packed(Waveform.Packed):
        """Cycles per ms and cycles at the start."""

        frequency_per_ms: float
        phase: float

    @classmethod
    def tone_hz(cls, params: Any) -> float:
        """Return its frequency in Hz."""
        return float(params.frequency_hz)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack frequency and phase."""
        p: Sine.Packed = super().pack(params, context)
        p.frequency_per_ms, p.phase = params.frequency_hz / 1e3, params.phase_deg / 360.0
        return p

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        """One line."""
        return [line(params.frequency_hz, params.phase_deg)]

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """Sine of frequency and phase."""
        return sin_of_turns(p.frequency_per_ms * t + p.phase)
