"""Base of every diagnoser that chooses between hypotheses."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from core.block import Block, Context, FloatArray, Oscillator
from core.diagnose.hypothesis import lacking
from core.elementary import log


def gaussian(residual: FloatArray, covariance: FloatArray) -> float:
    r"""Return the logarithm of the normal density, :math:`-\tfrac12(r^T\psi^{-1}r+\ln\det2\pi\psi)`.

    Parameters
    ----------
    residual : array of shape (n,)
    covariance : array of shape (n, n)
    """
    square = float(residual @ np.linalg.solve(covariance, residual))
    return -0.5 * (square + log(float(np.linalg.det(2.0 * math.pi * covariance))))


class Bank(Block):
    """A diagnoser with a model for each hypothesis; it takes in the voltage of every tick."""

    every_tick: ClassVar[bool] = True

    sample_by_sample: ClassVar[bool] = True
    """Whether a posterior is a prior times a likelihood, so that a single sample can be explained."""

    residuals: ClassVar[tuple[str, ...]] = ("residual",)
    """Taps of the residual, one for each displacement measured."""

    covariances: ClassVar[tuple[str, ...]] = ()
    """Taps of its covariance, upper triangle row by row; none where a single residual and its nis determine it."""

    gains: ClassVar[tuple[tuple[str, ...], ...]] = ()
    """Taps of the Kalman gain, a row for each state, a column for each residual; none without filters."""

    weighed: ClassVar[str] = "the probabilities before"
    """The prior of a sample, in words."""

    evidence: ClassVar[str] = ""
    """LaTeX of `log_likelihood`; empty for the logarithm of the normal density."""

    judged_by: ClassVar[str] = "nis"
    """Tap by which a hypothesis is judged: a square over its covariance, divided by the number of residuals."""

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
    def log_likelihood(
        cls, params: Any, context: Context, residual: FloatArray, covariance: FloatArray, tone: float
    ) -> float:
        """Return the logarithm of the density of a residual."""
        return gaussian(residual, covariance)
