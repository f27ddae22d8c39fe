r"""Angle random walk, bias instability and rate random walk of a rate, from its Allan deviation.

.. math:: \sigma^2(\tau)=\frac{N^2}\tau+\frac{2\ln2}\pi B^2+\frac{K^2\tau}3

(IEEE Std 952, annex C), fitted by least squares with no negative term.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.block import FloatArray
from core.format import format_in, format_si
from core.units import DEG_H_PER_DEG_S, DEG_H_RT_H_PER_DEG_S_RT_S, DEG_RT_H_PER_DEG_RT_S

LEAST_TIMES = 9
"""Averaging times that a record must hold: the deviation is then good to 25 % (IEEE Std 952, C.1)."""
LEAST_OCTAVES = 4
"""Octaves for three figures and a check."""
OVERLAP = 8.0
"""Most means that begin within one averaging time."""
PURITY = 0.04
"""Error of a variance that is always allowed: even with infinitely many averages, no rate is exactly these three
noises."""
MARGIN = 2
"""Octaves left out beyond the octaves that the three noises do not explain: the rest of a lag falls by half with
each."""
SHARED = 2.0
"""Variance of a term over the variance of independent octaves: all octaves share one record (measured for a random
walk)."""
STANDS_OUT = 3.0
"""Standard errors by which a term must exceed 0."""
PASSES = 30
FLOOR = 2.0 * math.log(2.0) / math.pi


@dataclass(frozen=True)
class RateNoiseFigure:
    """One of the three figures.

    Parameters
    ----------
    value : float, optional
        None where the record does not show it.
    error : float
        Standard error of the value, in its unit; without a value, the most it may be.
    reason : str
        Why there is no value.
    """

    value: float | None
    error: float = math.inf
    reason: str = ""


@dataclass(frozen=True)
class RateNoise:
    """The three figures: deg/rt h, deg/h, deg/h/rt h, and the averaging times in s that they were fitted to."""

    angle_random_walk: RateNoiseFigure
    bias_instability: RateNoiseFigure
    rate_random_walk: RateNoiseFigure
    from_s: float = 0.0
    to_s: float = 0.0


Octaves = Sequence[float] | FloatArray
"""A number for each octave of averaging time."""
UNITS = ("deg/rt h", "deg/h", "deg/h/rt h")
SCALES = (DEG_RT_H_PER_DEG_RT_S, DEG_H_PER_DEG_S, DEG_H_RT_H_PER_DEG_S_RT_S)


def averaging_times(averages: FloatArray) -> FloatArray:
    """Return how many times the averaging time the record is long, from the pairs of means of every octave."""
    overlap = np.minimum(2.0 ** np.arange(len(averages)), OVERLAP)
    times: FloatArray = (averages - 1.0) / overlap + 2.0
    return times


def fit(taus_s: Octaves, deviations: Octaves, averages: Octaves) -> RateNoise:
    r"""Fit the three noises to an Allan deviation by octaves.

    A variance over K averaging times has about K - 1 degrees of freedom; squares are weighed by their scatter according
    to the fit, pass by pass. Octaves with less than 9 averaging times are left out. The shortest octaves are also left
    out as long as the three noises do not explain them, and two more: there the loop that estimates the rate filters
    the noise. White noise through a lag of 50 ms is estimated within 2 %.

    Parameters
    ----------
    taus_s : sequence of float, shape (octaves,)
        Averaging times, s, each twice the time before.
    deviations : sequence of float, shape (octaves,)
        Allan deviations, deg/s.
    averages : sequence of float, shape (octaves,)
        Pairs of means in each, overlapping up to eightfold.

    Returns
    -------
    RateNoise
        Each figure, or the reason why the record does not show it.
    """
    taus, variances = np.array(taus_s, dtype=float), np.square(np.array(deviations, dtype=float))
    times = averaging_times(np.array(averages, dtype=float))
    used = (times >= LEAST_TIMES) & (variances > 0.0)
    taus, variances, times = taus[used], variances[used], times[used]
    if len(taus) < LEAST_OCTAVES:
        shortest = LEAST_TIMES * 2 ** (LEAST_OCTAVES - 1) * taus_s[0]
        return _nothing(
            f"needs {LEAST_OCTAVES} octaves, a record of {_seconds(shortest)} of a rate that is not constant"
        )
    last = len(taus) - LEAST_OCTAVES
    explained = (first for first in range(last + 1) if _explained(taus[first:], variances[first:], times[first:]))
    first = next(explained, None)
    if first is None:
        return _nothing("no sum of the three noises is like this deviation")
    if first > 0:
        first = min(first + MARGIN, last)
    terms, covariance, _ = _least_squares(taus[first:], variances[first:], times[first:])
    shorter = f"averages shorter than {_seconds(taus[first])}"
    longer = f"a record longer than {_seconds(np.max(taus * times))}"
    return RateNoise(
        _figure(0, terms, covariance, shorter),
        _figure(1, terms, covariance, longer),
        _figure(2, terms, covariance, longer),
        from_s=float(taus[first]),
        to_s=float(taus[-1]),
    )


def _explained(taus: FloatArray, variances: FloatArray, times: FloatArray) -> bool:
    """Say whether the three noises leave no more than scatter: the mean of chi-square and one standard deviation."""
    terms, _, misfit = _least_squares(taus, variances, times)
    freedom = len(taus) - int(np.count_nonzero(terms))
    return misfit <= freedom + math.sqrt(2.0 * freedom)


def _least_squares(taus: FloatArray, variances: FloatArray, times: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Return N^2, B^2 and K^2 in deg and s, their covariance, and the sum of squares in units of its scatter."""
    from scipy.optimize import nnls  # a quarter of a second to load, for few benches

    basis = np.column_stack([1.0 / taus, np.full_like(taus, FLOOR), taus / 3.0])
    scatter = np.sqrt(2.0 / (times - 1.0) + PURITY**2)
    model = variances
    for _ in range(PASSES):
        weighted = basis / (scatter * model)[:, None]
        size = np.linalg.norm(weighted, axis=0)
        terms = nnls(weighted / size, variances / (scatter * model))[0] / size
        model = basis @ terms
    misfit = float(np.sum(np.square((variances / model - 1.0) / scatter)))
    weighted = basis / (scatter * model)[:, None]
    size = np.linalg.norm(weighted, axis=0)
    covariance = SHARED * np.linalg.inv((weighted / size).T @ (weighted / size)) / np.outer(size, size)
    return terms, covariance, misfit


def _figure(which: int, terms: FloatArray, covariance: FloatArray, needs: str) -> RateNoiseFigure:
    """Return one figure; a figure below the noise has an upper limit, and needs another record."""
    term, deviation, scale = float(terms[which]), math.sqrt(covariance[which, which]), SCALES[which]
    if term > STANDS_OUT * deviation:
        value = math.sqrt(term)
        return RateNoiseFigure(scale * value, scale * 0.5 * deviation / value)
    most = scale * math.sqrt(term + STANDS_OUT * deviation)
    return RateNoiseFigure(None, most, f"is below the noise, at most {format_si(most, UNITS[which], 3)}; needs {needs}")


def _seconds(duration_s: float) -> str:
    return format_in(float(duration_s), "s", 0 if duration_s >= 100.0 else 3)


def _nothing(reason: str) -> RateNoise:
    none = RateNoiseFigure(None, reason=reason)
    return RateNoise(none, none, none)
