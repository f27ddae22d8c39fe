"""A single sample explained: from prior and residual to posterior, in numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, Field

from core.board.instances import scored
from core.board.spec import Section, Spec
from core.diagnose.bank import Bank
from core.diagnose.hypothesis import hypotheses_of
from core.errors import InputError

SMALLEST = 1e-30
"""Square of a residual below which the covariance cannot be read from it."""


class ModelAccount(BaseModel):
    """One hypothesis before and after a sample."""

    name: str
    residual_um: float
    covariance_um2: float | None
    log_likelihood: float | None
    prior: float
    posterior: float
    recorded: float


class Account(BaseModel):
    """All hypotheses before and after a sample; the recorded probabilities stand beside those worked out here.

    They part where the sample was no evidence, because the drive was off or nothing was measured.
    """

    kind: str
    tick: int
    time_ms: float
    floor: float
    evidence: str = Field(description="What log_likelihood is, in LaTeX; empty for that of the normal density")
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
    ports = ["probability", "residual", "nis"]
    if any(port.name == "tone" for port in block.taps):
        ports.append("tone")
    return [f"{port}.{item.name}" for port in ports for item in hypotheses_of(section.params)]


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
    labels = [item.name for item in params.hypotheses]

    def read(values: Mapping[str, float], port: str, label: str) -> float:
        return float(values.get(f"{port}.{label}", 0.0))

    last = [1.0 / len(labels)] * len(labels) if before is None else [read(before, "probability", x) for x in labels]
    priors = block.prior(params, last)
    rows: list[tuple[float, float | None, float | None]] = []
    for label in labels:
        residual = read(now, "residual", label)
        covariance = _covariance(residual, read(now, "nis", label))
        if covariance is None and before is not None:
            covariance = _covariance(read(before, "residual", label), read(before, "nis", label))
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
        evidence=block.evidence,
        models=[
            ModelAccount(
                name=label,
                residual_um=residual,
                covariance_um2=covariance,
                log_likelihood=density,
                prior=prior,
                posterior=posterior,
                recorded=read(now, "probability", label),
            )
            for label, (residual, covariance, density), prior, posterior in zip(
                labels, rows, priors, posteriors, strict=True
            )
        ],
    )


def _covariance(residual: float, nis: float) -> float | None:
    square = residual * residual
    return square / nis if square > SMALLEST and nis > 0.0 else None


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
