"""Step of the rate."""

from __future__ import annotations

from core.block import Equation, parameter
from core.kernel import kernel
from core.rate.drift import DriftParams
from core.rate.generator import NOISE, RateGenerator


class StepRate(RateGenerator):
    r"""Step of the rate, :math:`\Omega(t)=\Omega_0\,1(t-t_0)`."""

    title = "Step of the rate"
    equations = (Equation("rate", r"\Omega(t)=\Omega_0\,1(t-t_0)"), NOISE)

    class Params(DriftParams):
        """Height and moment of the step."""

        deg_per_s: float = parameter(100.0, "angular rate after the step", "deg/s", equation="rate", ge=-1e6, le=1e6)
        start_ms: float = parameter(0.0, "moment of the step", "ms", equation="rate", ge=0, le=1e9)

    class Packed(RateGenerator.Packed):
        """Height and moment of the step."""

        deg_per_s: float
        start_ms: float

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """Zero before the moment, the rate from it on."""
        return p.deg_per_s if t >= p.start_ms else 0.0
