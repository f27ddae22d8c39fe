"""Pseudo-random binary sequence."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, parameter
from core.elementary import floor
from core.kernel import kernel
from core.noise import uniform
from core.record import stream
from core.reference.waveform import ReferenceParams, Waveform


class Prbs(Waveform):
    r"""Random signs held for one chip each, :math:`r(t)=r_0\pm A`; the same seed gives the same sequence."""

    title = "Pseudo-random binary sequence"
    equations = (Equation("reference", r"r(t)=r_0+A\,b_{\lfloor f_c t\rfloor},\quad b_i\in\{-1,1\}"),)

    class Params(ReferenceParams):
        """Parameters of a binary sequence."""

        chip_rate_hz: float = parameter(10000.0, "chips per second", "Hz", gt=0, le=1e6)

    class Packed(Waveform.Packed):
        """Chips per ms and the key of the sequence."""

        chips_per_ms: float
        key: float = stream("reference.prbs")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the rate of the chips and the key of the sequence."""
        p: Prbs.Packed = super().pack(params, context)
        p.chips_per_ms = params.chip_rate_hz / 1e3
        return p

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """Sign of the chip that is on now."""
        return 1.0 if uniform(p.key, floor(t * p.chips_per_ms)) < 0.5 else -1.0
