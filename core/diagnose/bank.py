"""Base of every diagnoser that chooses between hypotheses."""

from __future__ import annotations

import math
from typing import Any, ClassVar

from core.block import Block, Context, Oscillator
from core.diagnose.hypothesis import lacking


def gaussian(residual: float, covariance: float) -> float:
    """Return the logarithm of the normal density."""
    return -0.5 * (residual * residual / covariance + math.log(2.0 * math.pi * covariance))


class Bank(Block):
    """A diagnoser with a model for each hypothesis; it takes in the voltage of every tick."""

    every_tick: ClassVar[bool] = True

    sample_by_sample: ClassVar[bool] = True
    """Whether a posterior is a prior times a likelihood, so that a single sample can be explained."""

    evidence: ClassVar[str] = ""
    """LaTeX of `log_likelihood`; empty for the logarithm of the normal density."""

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse plants without mass or spring."""
        return lacking(device)

    @classmethod
    def prior(cls, params: Any, before: list[float]) -> list[float]:
        """Return the probabilities before a measurement from those after the last one."""
        return before

    @classmethod
    def floor(cls, params: Any) -> float:
        """Return the smallest probability, 0 where there is none."""
        return 0.0

    @classmethod
    def log_likelihood(cls, params: Any, context: Context, residual: float, covariance: float, tone: float) -> float:
        """Return the logarithm of the density of a residual."""
        return gaussian(residual, covariance)
