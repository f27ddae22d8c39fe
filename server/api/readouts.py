"""Read-outs of a live bench: the Allan deviation of the rate so far, and the estimates of its noises."""

from __future__ import annotations

import math
from typing import Any, cast

import numpy as np
from pydantic import BaseModel, Field

from core.errors import unknown
from core.rate.drift import DriftParams
from core.readout.allan import OCTAVES, Allan
from core.theory.rate_noise import UNITS, fit
from core.units import DEG_H_PER_DEG_S
from server.api.deps import SessionDep
from server.api.router import Router

router = Router(prefix="/benches/{bench_id}/readouts", tags=["readouts"])


class Octave(BaseModel):
    """The Allan deviation over one averaging time, from a number of pairs of means."""

    tau_s: float
    deviation_deg_h: float
    pairs: int


class NoiseFigure(BaseModel):
    """One of the three noises: its estimate from the record, and its parameter on the bench."""

    name: str
    letter: str
    unit: str
    value: float | None = Field(description="Null where the record does not tell")
    error: float | None = Field(description="Standard error; without a value the most it may be, null if unknown")
    reason: str = Field(description="Why there is no value, and how to get one")
    true: float = Field(description="The noise of the angular rate itself; a sensor adds its own")


class RateReadout(BaseModel):
    """The Allan deviation of the rate so far, and the noises fitted to it."""

    tick: int
    record_s: float
    octaves: list[Octave] = Field(description="Octaves with a pair, by rising averaging time")
    figures: list[NoiseFigure]
    from_s: float = Field(description="The shortest averaging time of the fit; 0 without one")
    to_s: float


FIGURES = (
    ("angle random walk", "N", "angle_random_walk", "angle_random_walk_deg_rt_h"),
    ("bias instability", "B", "bias_instability", "bias_instability_deg_h"),
    ("rate random walk", "K", "rate_random_walk", "rate_random_walk_deg_h_rt_h"),
)


@router.get("/{name}")
def get_readout(session: SessionDep, name: str) -> RateReadout:
    """Fit angle random walk, bias instability and rate random walk to the record so far."""
    spec = session.board.spec
    deviations_of = {key: section for key, section in spec.readouts.items() if issubclass(section.block, Allan)}
    if name not in deviations_of:
        raise unknown("Allan deviation", name, deviations_of, "name")
    section = deviations_of[name]
    taus_s = Allan.taus_s(section.params, spec.context(section.every))
    tick = session.history.end_tick
    columns = [*(f"{name}.deviation.{m}" for m in OCTAVES), *(f"{name}.averages.{m}" for m in OCTAVES)]
    latest = session.history.read(session.indices(columns), tick - 1, tick)
    values = np.nan_to_num(latest[:, 0].astype(float)) if latest.shape[1] else np.zeros(len(columns))
    deviations, pairs = values[: len(OCTAVES)], values[len(OCTAVES) :]
    noise = fit(taus_s, deviations, pairs)
    true = cast(DriftParams, spec.generators["rate"].params)
    figures = []
    for (words, letter, field, parameter), unit in zip(FIGURES, UNITS, strict=True):
        figure: Any = getattr(noise, field)
        figures.append(
            NoiseFigure(
                name=words,
                letter=letter,
                unit=unit,
                value=figure.value,
                error=figure.error if math.isfinite(figure.error) else None,
                reason=figure.reason,
                true=getattr(true, parameter),
            )
        )
    return RateReadout(
        tick=tick,
        record_s=taus_s[0] * (pairs[0] + 1.0) if pairs[0] else 0.0,
        octaves=[
            Octave(tau_s=tau, deviation_deg_h=DEG_H_PER_DEG_S * deviation, pairs=int(count))
            for tau, deviation, count in zip(taus_s, deviations, pairs, strict=True)
            if count
        ],
        figures=figures,
        from_s=noise.from_s,
        to_s=noise.to_s,
    )
