"""Diagnosis: a sample of a verdict explained, and hypotheses that coincide under the drive."""

from __future__ import annotations

import asyncio
import math
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Path, Query
from pydantic import BaseModel, Field

from core.board.explain import Account, explain, signals_of
from core.board.spec import Spec
from core.diagnose.aliases import AliasMap, alias_map
from core.diagnose.hypothesis import BankParams, Hypothesis
from core.errors import InputError, unknown
from server.api.bodies import Body, StrictRoute
from server.api.deps import SessionDep
from server.bench.session import Session

router = APIRouter(prefix="/benches/{bench_id}/diagnosers/{name}", tags=["diagnosis"], route_class=StrictRoute)

Name = Annotated[str, Path(max_length=80, description="Id of the diagnoser; of a twin's: <twin>:<id>")]
MOST_HYPOTHESES = 16
SWEEP_POINTS = 160
SWEEP_SPAN = 4.0


class DriveTone(Body):
    """One tone of a drive."""

    frequency_hz: float = Field(gt=0, le=1e8)
    amplitude_v: float = Field(gt=0, le=1e4)


class AliasSource(Body):
    """Which hypotheses under which drive; those of the diagnoser under the drive of the bench unless given."""

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
    """Where hypotheses lie apart and where they coincide, now and at other drive frequencies."""

    map: AliasMap
    sensor_noise_um: float
    f0_hz: float
    sweep: AliasSweep


@router.get("/explanation")
async def get_explanation(session: SessionDep, name: Name, tick: Annotated[int, Query(ge=0, le=2**53)]) -> Account:
    """Explain what one sample did to the probabilities; of the history as far as it is kept."""
    return await asyncio.to_thread(_explain, session, name, tick)


@router.post("/aliases")
async def get_aliases(session: SessionDep, name: Name, body: AliasSource) -> AliasReport:
    """Say which hypotheses of a list the drive does not tell apart."""
    return await asyncio.to_thread(_aliases, session, name, body)


def _find(session: Session, name: str) -> tuple[Spec, str, str]:
    """Return the bench a diagnoser is on, what its signals begin with, and its id there."""
    twin, _, own = name.rpartition(":")
    boards = {"": session.board, **getattr(session.board, "twins", {})}
    if name not in session.board.diagnosers or twin not in boards:
        raise unknown("diagnoser", name, session.board.diagnosers, "diagnoser")
    return boards[twin].spec, f"{twin}:" if twin else "", own


def _explain(session: Session, name: str, tick: int) -> Account:
    spec, prefix, own = _find(session, name)
    every = spec.diagnosers[own].every
    tick -= tick % every
    names = signals_of(spec, own)
    columns = session.indices([prefix + signal for signal in names])
    history = session.history
    start = max(tick - every, 0)
    samples = history.read(columns, start, tick + 1)
    if samples.shape[1] != tick + 1 - start:
        span = f"{history.first_tick + every} to {history.end_tick - 1}"
        raise InputError(f"nothing is kept of tick {tick}; the history has {span}", "tick")

    def at(column: int) -> dict[str, float]:
        return dict(zip(names, map(float, samples[:, column]), strict=True))

    return explain(spec, own, tick, at(0) if tick >= every else None, at(-1))


def _aliases(session: Session, name: str, body: AliasSource) -> AliasReport:
    spec, _, own = _find(session, name)
    section = spec.diagnosers[own]
    if not isinstance(section.params, BankParams):
        raise InputError(f"{section.block.name} has no list of hypotheses", "diagnoser")
    hypotheses = body.hypotheses or section.params.hypotheses
    tones = [(tone.frequency_hz, tone.amplitude_v) for tone in body.tones] if body.tones else drive_tones(spec)
    context = spec.context(section.every)
    nominal = context.device
    found = alias_map(hypotheses, nominal, tones, body.within_um)
    f0 = 1e3 * nominal.natural_frequency / (2.0 * math.pi)
    centre = math.sqrt(f0 * tones[0][0])
    grid = np.geomspace(centre / SWEEP_SPAN, centre * SWEEP_SPAN, SWEEP_POINTS).tolist()
    closest = [alias_map(hypotheses, nominal, [(hz, tones[0][1])]).pairs[0] for hz in grid]
    named = sorted({(pair.first, pair.second) for pair in closest})
    return AliasReport(
        map=found,
        sensor_noise_um=context.sensor_noise_um,
        f0_hz=f0,
        sweep=AliasSweep(
            frequency_hz=grid,
            distance_um=[pair.distance_um for pair in closest],
            pair=[named.index((pair.first, pair.second)) for pair in closest],
            pairs_named=[NamedPair(first=first, second=second) for first, second in named],
        ),
    )


def drive_tones(spec: Spec) -> list[tuple[float, float]]:
    """Return frequency and amplitude of every tone of the reference.

    Raises
    ------
    InputError
        When it is none of tones.
    """
    params: Any = spec.reference.params
    kind = spec.reference.block.name
    volts = params.volts(spec.context())
    if kind == "sine":
        return [(params.frequency_hz, volts)]
    if kind == "multi_sine":
        return [(tone.frequency_hz, volts * tone.amplitude) for tone in params.tones if tone.frequency_hz > 0.0]
    raise InputError(f"the reference is a {kind}, which is not made of tones", "tones", "give the tones to look at")
