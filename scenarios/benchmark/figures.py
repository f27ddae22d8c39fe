"""Figures of a diagnoser in one case: pure functions of evidence, probabilities and truth.

Sums are made one sample after another, and logarithms by the project's own function, so that figures have the same bits
on every machine.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from pydantic import BaseModel

from core.block import BoolArray, FloatArray, IntArray
from core.elementary import log
from core.kernel import kernel
from core.loop.score import HELD

LEAST = 1e-300
FLOOR = 1e-6
"""Smallest probability of the log score: the truth called impossible costs 13.8 nats a sample and not without end."""
BINS = 10
"""Bins of the reliability curve, from 0 to 1."""
WIDE = 1.959963984540054
"""Standard errors to either side of a mean that hold 95 %."""


def surprise(healthy: FloatArray) -> FloatArray:
    r"""Return the evidence of a fault, :math:`-\ln p_\text{healthy}`; no number counts as 0."""
    found = np.empty(len(healthy))
    _surprise(healthy, found)
    return found


@kernel
def _surprise(healthy: FloatArray, found: FloatArray) -> None:
    for i in range(len(healthy)):
        found[i] = -log(healthy[i] if healthy[i] > LEAST else LEAST)


def classed(probabilities: FloatArray, classes: IntArray, count: int) -> FloatArray:
    """Return the probability of each class, shape (count, samples): the share of its hypotheses in the sum of all.

    Parameters
    ----------
    probabilities : ndarray, shape (hypotheses, samples)
        The given probabilities; less than 0 or no number counts as 0.
    classes : ndarray
        The class of each hypothesis.
    count : int
        Classes.
    """
    found = np.zeros((count, probabilities.shape[1]))
    _classify(probabilities, classes, found)
    return found


@kernel
def _classify(probabilities: FloatArray, classes: IntArray, found: FloatArray) -> None:
    """Write shares over zeros."""
    hypotheses, samples = probabilities.shape
    for i in range(samples):
        total = 0.0
        for h in range(hypotheses):
            p = probabilities[h, i]
            p = p if 0.0 < p < np.inf else 0.0
            found[classes[h], i] += p
            total += p
        for c in range(found.shape[0]):
            found[c, i] = found[c, i] / total if total > 0.0 else 0.0


@kernel
def scores(p: FloatArray, truth: IntArray) -> tuple[float, float]:
    r"""Return the log score and Brier's score, means over the samples; less is better.

    .. math:: L=-\overline{\ln\max(p_\text{truth},10^{-6})},\qquad B=\overline{\textstyle\sum_c(p_c-o_c)^2}

    Both are proper: on average a diagnoser loses least when it states its true probabilities (Brier 1950; Good 1952;
    Gneiting and Raftery 2007).
    """
    classes, samples = p.shape
    logs, squares = 0.0, 0.0
    for i in range(samples):
        said = p[truth[i], i]
        logs -= log(said if said > FLOOR else FLOOR)
        for c in range(classes):
            error = p[c, i] - (1.0 if c == truth[i] else 0.0)
            squares += error * error
    return logs / samples, squares / samples


def named(p: FloatArray, first: int) -> IntArray:
    """Return the most probable class of each sample, of those from ``first`` on, the first of several alike."""
    found = np.empty(p.shape[1], dtype=np.int64)
    _name(p, first, found)
    return found


@kernel
def _name(p: FloatArray, first: int, found: IntArray) -> None:
    classes, samples = p.shape
    for i in range(samples):
        best = first
        for c in range(first + 1, classes):
            if p[c, i] > p[best, i]:
                best = c
        found[i] = best


def reliability(p: FloatArray, truth: IntArray) -> FloatArray:
    """Count samples by the probability of the class that is named, shape (3, BINS): how many, that sum, how many right.

    Of a calibrated diagnoser the share of right ones in a bin is the mean probability said there (Dawid 1982).
    """
    counts = np.zeros((3, BINS))
    _bin(p, truth, counts)
    return counts


@kernel
def _bin(p: FloatArray, truth: IntArray, counts: FloatArray) -> None:
    """Add to counts."""
    classes, samples = p.shape
    for i in range(samples):
        best = 0
        for c in range(1, classes):
            if p[c, i] > p[best, i]:
                best = c
        place = min(int(p[best, i] * BINS), BINS - 1)
        counts[0, place] += 1.0
        counts[1, place] += p[best, i]
        counts[2, place] += 1.0 if best == truth[i] else 0.0


@kernel
def false_switches(said: IntArray, truth: IntArray) -> int:
    """Count exits from the truth after it was found, by 20 right verdicts in a row, and before it changes."""
    exits, run, found = 0, 0, False
    for i in range(len(said)):
        if i > 0 and truth[i] != truth[i - 1]:
            run, found = 0, False
        if said[i] == truth[i]:
            run += 1
            found = found or run >= HELD
        else:
            exits += 1 if found and run > 0 else 0
            run = 0
    return exits


def found_within(delays: Sequence[float | None], limits: Sequence[int]) -> list[float]:
    """Return the share of existing delays that are at most each limit; empty without a delay."""
    there = [delay for delay in delays if delay is not None]
    return [sum(delay <= limit for delay in there) / len(there) for limit in limits] if there else []


class Estimate(BaseModel):
    """A mean over cases and its standard error; cases do not depend on one another, samples of one case do."""

    mean: float
    error: float
    cases: int


def estimate(values: Iterable[float | None]) -> Estimate | None:
    """Return the mean over the cases that have a figure, or None if none has."""
    there = [value for value in values if value is not None]
    n = len(there)
    if not n:
        return None
    mean = math.fsum(there) / n
    spread = math.fsum((value - mean) ** 2 for value in there)
    return Estimate(mean=mean, error=math.sqrt(spread / (n - 1) / n) if n > 1 else 0.0, cases=n)


def rises(on: BoolArray) -> int:
    """Return how often an alarm starts."""
    return int(np.count_nonzero(on[1:] & ~on[:-1]))


@dataclass(frozen=True)
class Alarms:
    """How the alarm of one case went: see `alarms`."""

    detection: float
    false_alarm: float
    episodes: int
    delay: float | None
    missed: float | None


def alarms(evidence: FloatArray, threshold: float, start: int, onset: int) -> Alarms:
    """Return the figures of an alarm that is on while the evidence is above a threshold.

    ``detection`` is the share of faulty samples with the alarm on, ``false_alarm`` the share of healthy samples with
    the alarm on, as the DX competitions count, ``episodes`` how often it starts while the device is healthy. The delay
    is the number of samples from the fault to the first alarm, and all remaining samples for a missed fault, so that
    missing never pays. An alarm that is already on when the fault happens is no detection: such a case has no delay.

    Parameters
    ----------
    evidence : ndarray
        The evidence, which grows with a fault.
    threshold : float
        The alarm is on above it.
    start, onset : int
        First sample that counts, and first sample of the fault.
    """
    on = evidence > threshold
    quiet, loud = on[start:onset], on[onset:]
    stands = bool(quiet[-1])
    first = np.flatnonzero(loud)
    return Alarms(
        detection=int(np.count_nonzero(loud)) / len(loud),
        false_alarm=int(np.count_nonzero(quiet)) / len(quiet),
        episodes=rises(quiet),
        delay=None if stands else float(first[0]) if len(first) else float(len(loud)),
        missed=None if stands else float(len(first) == 0),
    )


def isolation(p: FloatArray, on: BoolArray, truth: int, onset: int) -> tuple[float | None, float] | None:
    """Return two shares of the faulty samples with the alarm on: named rightly, and given to the truth.

    The first is the isolation rate, which needs two kinds of fault. The second, the mean probability of the truth where
    a fault is detected, is a ranking of a DX competition; it is linear in the stated probability, so it rewards
    overconfident diagnosers.
    """
    faulty = np.ascontiguousarray(p[:, onset:][:, on[onset:]])
    classes, samples = faulty.shape
    if samples == 0:
        return None
    right = int(np.count_nonzero(named(faulty, 1) == truth)) / samples if classes > 2 else None
    return right, math.fsum(faulty[truth].tolist()) / samples
