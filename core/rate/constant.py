"""Constant rate."""

from __future__ import annotations

from core.block import Equation, parameter
from core.kernel import kernel
from core.rate.drift import DriftParams
from core.rate.generator import NOISE, RateGenerator


class ConstantRate(RateGenerator):
    r"""Constant rate, :math:`\Omega(t)=\Omega_0`."""

    title = "Constant rate"
    equations = (Equation("rate", r"\Omega(t)=\Omega_0"), NOISE)

    class Params(DriftParams):
        """The rate."""

        deg_per_s: float = parameter(0.0, "angular rate", "deg/s", equation="rate", ge=-1e6, le=1e6)

    class Packed(RateGenerator.Packed):
        """The rate."""

        deg_per_s: float

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """Return the rate at any time."""
        return p.deg_per_s
