"""The Allan deviation of a rate so far, and the estimates of its noises beside their true values."""

from __future__ import annotations

import math
from typing import cast

import numpy as np
from pydantic import BaseModel, Field

from core.block import FloatArray
from core.board.spec import Spec
from core.errors import unknown
from core.rate.drift import DriftParams
from core.readout.allan import OCTAVES, Allan
from core.theory.rate_noise import UNITS, fit
from core.units import DEG_H_PER_DEG_S

NOISES = (
    ("angle random walk", "N", "angle_random_walk_deg_rt_h"),
    ("bias instability", "B", "bias_instability_deg_h"),
    ("rate random walk", "K", "rate_random_walk_deg_h_rt_h"),
)
"""Name, letter and parameter of each noise, in the order of the fit."""


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
    value: float | None = Field(description="Null where the record does not show it")
    error: float | None = Field(
        description="Standard error of the value; without a value, the most that the noise may be; null if unknown"
    )
    reason: str = Field(description="Why there is no value, and how to get one; empty with a value")
    true: float = Field(description="Noise of the angular rate itself; the noise of a sensor adds to it")


class RateReadout(BaseModel):
    """The Allan deviation of the rate so far, and the noises fitted to it."""

    tick: int
    record_s: float
    octaves: list[Octave] = Field(description="Octaves with at least one pair, by rising averaging time")
    figures: list[NoiseFigure]
    from_s: float = Field(description="Shortest averaging time of the fit; 0 without a fit")
    to_s: float = Field(description="Longest averaging time of the fit; 0 without a fit")


def readout_signals(spec: Spec, name: str) -> list[str]:
    """Return the signals of an Allan deviation: its deviations, then its numbers of pairs.

    Raises
    ------
    InputError
        When the bench has no such read-out.
    """
    known = [key for key, section in spec.readouts.items() if issubclass(section.block, Allan)]
    if name not in known:
        raise unknown("Allan deviation", name, known, "name")
    return [*(f"{name}.deviation.{m}" for m in OCTAVES), *(f"{name}.averages.{m}" for m in OCTAVES)]


def rate_readout(spec: Spec, name: str, tick: int, latest: FloatArray) -> RateReadout:
    """Fit the noises to the values of `readout_signals` at the last tick."""
    section = spec.readouts[name]
    taus_s = Allan.taus_s(section.params, spec.context(section.every))
    deviations, pairs = np.nan_to_num(latest).reshape(2, len(OCTAVES))
    noise = fit(taus_s, deviations, pairs)
    true = cast(DriftParams, spec.generators["rate"].params)
    found = (noise.angle_random_walk, noise.bias_instability, noise.rate_random_walk)
    return RateReadout(
        tick=tick,
        record_s=taus_s[0] * (pairs[0] + 1.0) if pairs[0] else 0.0,
        octaves=[
            Octave(tau_s=tau, deviation_deg_h=DEG_H_PER_DEG_S * deviation, pairs=int(count))
            for tau, deviation, count in zip(taus_s, deviations, pairs, strict=True)
            if count
        ],
        figures=[
            NoiseFigure(
                name=words,
                letter=letter,
                unit=unit,
                value=figure.value,
                error=figure.error if math.isfinite(figure.error) else None,
                reason=figure.reason,
                true=getattr(true, parameter),
            )
            for (words, letter, parameter), unit, figure in zip(NOISES, UNITS, found, strict=True)
        ],
        from_s=noise.from_s,
        to_s=noise.to_s,
    )
