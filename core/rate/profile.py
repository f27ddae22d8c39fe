"""Rate by breakpoints."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Self

from pydantic import model_validator

from core.block import BlockParams, Context, Equation, parameter
from core.kernel import kernel
from core.rate.drift import DriftParams
from core.rate.generator import NOISE, RateGenerator
from core.record import Choice, Record, Records, tail


class RateBreakpoint(BlockParams):
    """One breakpoint."""

    at_ms: float = parameter(0.0, "moment", "ms", ge=0, le=1e9)
    deg_per_s: float = parameter(0.0, "angular rate at this moment", "deg/s", ge=-1e6, le=1e6)


class PackedPoint(Record):
    """Moment in ms and rate in deg/s."""

    at_ms: float
    deg_per_s: float


class RateProfile(RateGenerator):
    r"""Rate by breakpoints, :math:`\Omega(t)=\Omega_i+(\Omega_{i+1}-\Omega_i)\frac{t-t_i}{t_{i+1}-t_i}`.

    Before the first breakpoint and after the last one the rate is theirs.
    """

    title = "Rate by breakpoints"
    equations = (
        Equation("rate", r"\Omega(t)=\Omega_i+(\Omega_{i+1}-\Omega_i)\frac{t-t_i}{t_{i+1}-t_i},\quad t_i\le t<t_{i+1}"),
        NOISE,
    )

    class Params(DriftParams):
        """The breakpoints."""

        points: list[RateBreakpoint] = parameter(
            [RateBreakpoint(), RateBreakpoint(at_ms=100.0, deg_per_s=100.0)],
            "the breakpoints, by rising moment",
            equation="rate",
            live=False,
        )

        @model_validator(mode="after")
        def _rising(self) -> Self:
            if not self.points:
                raise ValueError("needs at least one point")
            for before, after in pairwise(self.points):
                if after.at_ms <= before.at_ms:
                    raise ValueError(f"points must rise in at_ms, got {after.at_ms:g} after {before.at_ms:g}")
            return self

    class Packed(RateGenerator.Packed):
        """How many breakpoints, and each."""

        count: Choice
        points: Records[PackedPoint] = tail()

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the breakpoints."""
        p: RateProfile.Packed = super().pack(params, context)
        p.count = len(params.points)
        for point, packed in zip(params.points, p.points, strict=True):
            packed.at_ms, packed.deg_per_s = point.at_ms, point.deg_per_s
        return p

    @classmethod
    def tails(cls, params: Any) -> int:
        """Return how many breakpoints there are."""
        return len(params.points)

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """Bisect for the breakpoints to either side, and take the line between them."""
        low, high = 0, int(p.count) - 1
        if t <= p.points[low].at_ms:
            return p.points[low].deg_per_s
        if t >= p.points[high].at_ms:
            return p.points[high].deg_per_s
        while high - low > 1:
            middle = (low + high) // 2
            if p.points[middle].at_ms <= t:
                low = middle
            else:
                high = middle
        before, after = p.points[low], p.points[high]
        share = (t - before.at_ms) / (after.at_ms - before.at_ms)
        return before.deg_per_s + share * (after.deg_per_s - before.deg_per_s)
