"""Aliases of a list of hypotheses: which of them coincide under a drive, and at which other frequencies."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from fastapi import Path
from pydantic import BaseModel, Field

from core.block import Oscillator
from core.diagnose.aliases import AliasMap, alias_map
from core.diagnose.hypothesis import Hypothesis
from core.errors import InputError
from server.api.bodies import Body
from server.api.deps import ComputingDep, SessionDep
from server.api.diagnosers import hypotheses_of, spec_and_section, tones_of
from server.api.router import Router

router = Router(prefix="/benches/{bench_id}/diagnosers/{name}", tags=["diagnosis"])

Name = Annotated[str, Path(max_length=80, description="Id of the diagnoser; of a twin's: <twin>:<id>")]
MOST_HYPOTHESES = 16
SWEEP_POINTS = 160
SWEEP_SPAN = 4.0


class DriveTone(Body):
    """One tone of a drive."""

    frequency_hz: float = Field(gt=0, le=1e8)
    amplitude_v: float = Field(gt=0, le=1e4)


class AliasSource(Body):
    """Hypotheses and a drive; the defaults are the hypotheses of the diagnoser and the drive of the bench."""

    hypotheses: list[Hypothesis] | None = Field(None, min_length=2, max_length=MOST_HYPOTHESES)
    tones: list[DriveTone] | None = Field(None, min_length=1, max_length=32)
    within_um: float = Field(0.0, ge=0, le=1e6, description="Distance below which two count as coincident")


class NamedPair(BaseModel):
    """Two hypotheses."""

    first: str
    second: str


class AliasSweep(BaseModel):
    """For a single tone of the first amplitude, the closest pair over frequency."""

    frequency_hz: list[float]
    distance_um: list[float]
    pair: list[int] = Field(description="Index into pairs_named")
    pairs_named: list[NamedPair]


class AliasReport(BaseModel):
    """The separate hypotheses and the coinciding hypotheses, now and at other drive frequencies."""

    map: AliasMap
    sensor_noise_um: float
    f0_hz: float
    sweep: AliasSweep


@router.post("/aliases")
async def get_aliases(session: SessionDep, name: Name, body: AliasSource, computing: ComputingDep) -> AliasReport:
    """Report the hypotheses of a list that look alike under the drive."""
    spec, section = spec_and_section(session, name)
    hypotheses = body.hypotheses or hypotheses_of(section)
    context = spec.context(spec.turns(section))
    tones = [(tone.frequency_hz, tone.amplitude_v) for tone in body.tones] if body.tones else tones_of(spec)
    if not tones:
        raise InputError("the reference has no tone of its own", "tones", "give the tones to look at")
    return await computing.call(_aliases, hypotheses, context.device, tones, body.within_um, context.sensor_noise_um)


def _aliases(
    hypotheses: list[Hypothesis],
    nominal: Oscillator,
    tones: list[tuple[float, float]],
    within_um: float,
    sensor_noise_um: float,
) -> AliasReport:
    now = alias_map(hypotheses, nominal, tones, within_um)
    f0 = 1e3 * nominal.natural_frequency / (2.0 * math.pi)
    # An axis of octaves has no place for a constant, so the map is then drawn around the resonance.
    centre = math.sqrt(f0 * (tones[0][0] or f0))
    grid = np.geomspace(centre / SWEEP_SPAN, centre * SWEEP_SPAN, SWEEP_POINTS).tolist()
    closest = [alias_map(hypotheses, nominal, [(hz, tones[0][1])]).pairs[0] for hz in grid]
    named = sorted({(pair.first, pair.second) for pair in closest})
    return AliasReport(
        map=now,
        sensor_noise_um=sensor_noise_um,
        f0_hz=f0,
        sweep=AliasSweep(
            frequency_hz=grid,
            distance_um=[pair.distance_um for pair in closest],
            pair=[named.index((pair.first, pair.second)) for pair in closest],
            pairs_named=[NamedPair(first=first, second=second) for first, second in named],
        ),
    )
