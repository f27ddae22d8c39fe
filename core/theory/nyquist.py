"""The Nyquist curve of a transfer function over the frequencies that matter, with the verdict on its real part."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict

import numpy as np
from pydantic import BaseModel, Field

from core.theory.positive_real import nyquist, polynomial, positive_real

POINTS = 400
DECADES = 3.0
"""Decades that the curve spans beyond the poles and zeros, both ends together."""


class PositiveRealReport(BaseModel):
    """Whether a transfer function is positive real, why not, and its Nyquist curve."""

    strictly_positive_real: bool
    positive_real: bool
    hurwitz: bool
    minimum_phase: bool
    relative_degree: int
    least_real: float | None = Field(description="Smallest real part on the imaginary axis")
    at: float | None = Field(description="Frequency of the smallest real part; null: at infinity")
    reasons: list[str]
    frequency: list[float]
    real: list[float | None]
    imaginary: list[float | None]


def positive_real_report(numerator: Sequence[float], denominator: Sequence[float]) -> PositiveRealReport:
    """Judge a transfer function; coefficients highest power first. Numbers that are not finite become null."""
    verdict = asdict(positive_real(numerator, denominator))
    roots = np.concatenate([np.roots(polynomial(numerator, "")), np.roots(polynomial(denominator, ""))])
    sizes = [float(size) for size in np.abs(roots) if size > 0.0] or [1.0]
    low, high = math.log10(min(sizes)) - DECADES / 2, math.log10(max(sizes)) + DECADES / 2
    w = np.logspace(low, high, POINTS)
    with np.errstate(divide="ignore", invalid="ignore"):
        real, imaginary = nyquist(numerator, denominator, w)
    verdict |= {name: _finite(verdict[name]) for name in ("least_real", "at")}
    return PositiveRealReport(
        **verdict,
        frequency=w.tolist(),
        real=[_finite(value) for value in real.tolist()],
        imaginary=[_finite(value) for value in imaginary.tolist()],
    )


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
