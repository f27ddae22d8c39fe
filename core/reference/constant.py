"""Constant."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, kernel
from core.reference.waveform import ReferenceParams, Waveform, playing


@kernel
def constant(p: Any, t: float) -> float:
    """Return one at any time."""
    return 1.0


class Constant(Waveform):
    r"""Constant, :math:`r(t)=r_0+A`."""

    title = "Constant"
    equations = (Equation("reference", r"r(t)=r_0+A"),)

    class Params(ReferenceParams):
        """Parameters of a constant."""

    @classmethod
    def shape_parameters(cls, params: Any, context: Context) -> list[float]:
        """Nothing beyond the amplitude."""
        return []

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        """One line at rest."""
        return [(0.0, 1.0)]

    step = playing(constant)
