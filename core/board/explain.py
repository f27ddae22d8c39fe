"""A single sample explained: from prior and residual to posterior, in numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from pydantic import BaseModel, Field

from core.block import FloatArray
from core.board.instances import scored
from core.board.spec import Section, Spec
from core.diagnose.bank import Bank
from core.diagnose.hypothesis import names_of
from core.errors import InputError

SMALLEST = 1e-30
"""Square of a residual below which the covariance cannot be read from it."""


class Turn(BaseModel):
    """The last change of the verdict up to a sample."""

    tick: int | None = Field(description="First sample with the present verdict; null if that sample is no longer kept")
    before: str = Field(description="Verdict before that sample; empty without a change")
    since: int = Field(description="First sample that is kept")


class ModelAccount(BaseModel):
    """One hypothesis before and after a sample."""

    name: str
    residual_um: list[float] = Field(description="One residual for each measured displacement")
    covariance_um2: list[list[float]] | None = Field(description="Covariance of the residuals, row by row")
    log_likelihood: float | None
    prior: float
    posterior: float
    recorded: float
    missed_sigma: float = Field(
        description="Residuals in standard deviations: the root of the square by which the diagnoser judges"
    )
    gain: list[list[float]] = Field(
        description="Kalman gain, a row for each state and a column for each residual; empty without a filter"
    )


class Account(BaseModel):
    """All hypotheses before and after a sample; the recorded probabilities are next to the probabilities computed here.

    They differ where the sample was no evidence, because the drive was off or nothing was measured.
    """

    kind: str
    tick: int
    time_ms: float
    floor: float
    residuals: list[str] = Field(description="Signals of the residuals, without the name of the diagnoser")
    weighed: str = Field(description="Meaning of the prior, in words")
    evidence: str = Field(description="Formula of log_likelihood in LaTeX; empty for the normal density")
    gain_units: list[str] = Field(description="Units of the rows of each gain")
    models: list[ModelAccount]


def signals_of(section: Section) -> list[str]:
    """Return the signals of a diagnoser, below its name, whose values at two samples explain a verdict.

    Raises
    ------
    InputError
        When its probabilities do not come from prior and likelihood.
    """
    block = section.block
    if not (scored(block) and issubclass(block, Bank) and block.sample_by_sample):
        raise InputError(f"{block.name} does not weigh sample by sample", "name", "look at its signals instead")
    gains = [port for row in block.gains for port in row]
    ports = ["probability", *block.residuals, *block.covariances, "nis", *gains]
    if any(port.name == "tone" for port in block.taps):
        ports.append("tone")
    return [f"{port}.{name}" for port in ports for name in names_of(section.params)]


def last_turn(names: list[str], winners: FloatArray, first: int) -> Turn:
    """Return where a verdict last changed.

    Parameters
    ----------
    names : list of str
        Hypotheses.
    winners : array of shape (n,)
        Index of the hypothesis that won, or -1, at each tick from ``first`` on; not finite where nothing was kept.
    first : int
    """
    gaps = np.flatnonzero(~np.isfinite(winners))
    kept = int(gaps[-1]) + 1 if gaps.size else 0
    changes = np.flatnonzero(np.diff(winners[kept:]))
    if not changes.size:
        return Turn(tick=None, before="", since=first + kept)
    at = kept + int(changes[-1])
    loser = int(winners[at])
    return Turn(tick=first + at + 1, before=names[loser] if loser >= 0 else "", since=first + kept)


def explain(
    spec: Spec, section: Section, tick: int, before: Mapping[str, float] | None, now: Mapping[str, float]
) -> Account:
    """Work out the posterior of every hypothesis at a sample.

    Parameters
    ----------
    spec : Spec
        The bench.
    section : Section
        The diagnoser.
    tick : int
        The sample.
    before, now : mapping
        Values of ``signals_of`` at the sample before and at this one; nothing before the first.
    """
    block: Any = section.block
    params: Any = section.params
    context = spec.context(spec.turns(section))
    labels = names_of(params)

    def read(values: Mapping[str, float], port: str, label: str) -> float:
        return float(values.get(f"{port}.{label}", 0.0))

    last = [1.0 / len(labels)] * len(labels) if before is None else [read(before, "probability", x) for x in labels]
    priors = block.prior(params, last)
    rows: list[tuple[FloatArray, FloatArray | None, float | None]] = []
    for label in labels:
        residual = np.array([read(now, port, label) for port in block.residuals])
        if block.covariances:
            covariance = _symmetric([read(now, port, label) for port in block.covariances], len(residual))
        else:
            covariance = _covariance(residual, read(now, "nis", label))
            if covariance is None and before is not None:
                covariance = _covariance(np.array([read(before, "residual", label)]), read(before, "nis", label))
        density = (
            block.log_likelihood(params, context, residual, covariance, read(now, "tone", label))
            if covariance is not None
            else None
        )
        rows.append((residual, covariance, density))
    floor = block.floor(params)
    posteriors = _posteriors(priors, [row[2] for row in rows], floor)
    return Account(
        kind=block.name,
        tick=tick,
        time_ms=tick * spec.dt_ms,
        floor=floor,
        residuals=list(block.residuals),
        weighed=block.weighed,
        evidence=block.evidence,
        gain_units=[next(port.unit for port in block.taps if port.name == row[0]) for row in block.gains],
        models=[
            ModelAccount(
                name=label,
                residual_um=residual.tolist(),
                covariance_um2=None if covariance is None else covariance.tolist(),
                log_likelihood=density,
                prior=prior,
                posterior=posterior,
                recorded=read(now, "probability", label),
                missed_sigma=math.sqrt(read(now, block.judged_by, label) * len(block.residuals)),
                gain=[[read(now, port, label) for port in row] for row in block.gains],
            )
            for label, (residual, covariance, density), prior, posterior in zip(
                labels, rows, priors, posteriors, strict=True
            )
        ],
    )


def _covariance(residual: FloatArray, nis: float) -> FloatArray | None:
    """Return the covariance of a single residual from its normalised square; none where it is zero."""
    square = float(residual @ residual)
    return np.array([[square / nis]]) if square > SMALLEST and nis > 0.0 else None


def _symmetric(upper: list[float], size: int) -> FloatArray | None:
    """Return a covariance from its upper triangle, row by row; none before the first sample."""
    found = np.zeros((size, size))
    found[np.triu_indices(size)] = found.T[np.triu_indices(size)] = upper
    return found if np.linalg.det(found) > 0.0 else None


def _posteriors(priors: list[float], densities: list[float | None], floor: float) -> list[float]:
    """Multiply, normalise, lift to the floor, normalise."""
    logs = [
        math.log(prior) + density if prior > 0.0 and density is not None else -math.inf
        for prior, density in zip(priors, densities, strict=True)
    ]
    best = max(logs)
    if not math.isfinite(best):
        return priors
    shares = [math.exp(log - best) for log in logs]
    total = sum(shares)
    lifted = [max(share / total, floor) for share in shares]
    return [share / sum(lifted) for share in lifted]
