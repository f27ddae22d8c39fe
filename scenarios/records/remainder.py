r"""Another stretch of a record against a fit: the residual that the uncertainty of the fit does not explain.

.. math:: e = J\delta + v,\qquad \delta\sim N(0,\sigma^2K),\quad v\sim N(0,\sigma^2 I),\qquad S = I + JKJ^\mathsf{T}

A fit to slow tones knows little of the resonance, and its residual there is large without any fault of the model. Its
expected square is :math:`\sigma^2S`; so :math:`S^{-1}e` is the noise that remains when the fitted numbers move as far
as their uncertainty lets them, and :math:`e^\mathsf{T}S^{-1}e` over the samples is the variance of a sample.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from scenarios.records.columns import Numbers
from scenarios.records.fit import SKIPPED, Fit, responses, slopes

DELAY = 2
"""The delay among the fitted numbers."""


@dataclass(frozen=True)
class Remainder:
    """The unexplained residual on a stretch that was not fitted.

    Parameters
    ----------
    residual : array, shape (known samples,)
        um.
    size : float
        Standard deviation of a sample, um.
    missed_delay, delay_error : float
        The delay by which the stretch differs from the fitted one, and its standard error, in samples.
    """

    residual: Numbers = field(repr=False)
    size: float
    missed_delay: float
    delay_error: float


def remainder(found: Fit, drive: Numbers, displacement: Numbers, dt_ms: float) -> Remainder:
    """Return the remainder on another stretch; its first motion is fitted freely."""
    known = np.isfinite(displacement[SKIPPED:])
    basis = responses(found.stiffness, found.damping, found.delay, drive, dt_ms)[known]
    begun, triangle = np.linalg.qr(basis[:, 1:3])
    left = displacement[SKIPPED:][known] - found.gain * basis[:, 0] - found.offset
    first = np.linalg.lstsq(triangle, begun.T @ left)[0]

    def moved(columns: Numbers) -> Numbers:
        return columns - begun @ (begun.T @ columns)

    weights = np.array([found.gain, *first, found.offset])
    searched = slopes(found.searched, weights, drive, dt_ms)[known]
    left, jacobian = moved(left), moved(np.column_stack([searched, found.gain * basis[:, 0], basis[:, 3]]))
    sizes, directions = np.linalg.eigh(found.spread)
    explained, shares, _ = np.linalg.svd(jacobian @ directions * np.sqrt(np.maximum(sizes, 0.0)), full_matrices=False)
    shares = (shares / np.hypot(1.0, shares)) ** 2

    def unexplained(column: Numbers) -> Numbers:
        return np.asarray(column - explained @ (shares * (explained.T @ column)))

    residual, slope = unexplained(left), jacobian[:, DELAY]
    known_delay = float(slope @ unexplained(slope))
    return Remainder(
        residual=residual,
        size=math.sqrt(max(float(left @ residual), 0.0) / len(left)),
        missed_delay=float(slope @ residual) / known_delay if known_delay > 0.0 else 0.0,
        delay_error=math.sqrt(float(np.mean(residual**2)) / known_delay) if known_delay > 0.0 else math.inf,
    )
