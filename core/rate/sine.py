"""Sine of the rate."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, parameter
from core.device.ranges import Sized
from core.elementary import sin_of_turns
from core.kernel import kernel
from core.rate.drift import DriftParams
from core.rate.generator import NOISE, RateGenerator


class SineRate(RateGenerator):
    r"""Rate that swings, :math:`\Omega(t)=\Omega_0\sin(2\pi ft+\varphi)`."""

    title = "Sine of the rate"
    equations = (Equation("rate", r"\Omega(t)=\Omega_0\sin(2\pi ft+\varphi)"), NOISE)

    class Params(DriftParams):
        """One tone."""

        deg_per_s: float = parameter(100.0, "amplitude", "deg/s", equation="rate", ge=-1e6, le=1e6)
        frequency_hz: Sized = parameter(1.0, "frequency", "Hz", equation="rate", ge=0, le=1e6)
        phase_deg: float = parameter(0.0, "phase at t = 0", "deg", equation="rate")

    class Packed(RateGenerator.Packed):
        """Amplitude, cycles per ms and cycles at the start."""

        deg_per_s: float
        frequency_per_ms: float
        phase: float

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack frequency and phase."""
        p: SineRate.Packed = super().pack(params, context)
        p.frequency_per_ms, p.phase = params.frequency_hz / 1e3, params.phase_deg / 360.0
        return p

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """Sine of frequency and phase."""
        return p.deg_per_s * sin_of_turns(p.frequency_per_ms * t + p.phase)
