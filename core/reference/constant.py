"""Constant."""

from __future__ import annotations

from typing import Any

from core.block import Equation
from core.kernel import kernel
from core.reference.waveform import ReferenceParams, Waveform


class Constant(Waveform):
    r"""Constant, :math:`r(t)=r_0+A`."""

    title = "Constant"
    equations = (Equation("reference", r"r(t)=r_0+A"),)

    class Params(ReferenceParams):
        """Parameters of a constant."""

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        """One line at zero frequency."""
        return [(0.0, 1.0)]

    @staticmethod
    @kernel
    def shape(p: Waveform.Packed, t: float) -> float:
        """Return one at any time."""
        return 1.0
