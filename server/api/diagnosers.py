"""Diagnosers of a live bench: one sample explained, and hypotheses with equal responses under a drive."""

from __future__ import annotations

from typing import Annotated, Any, cast

import numpy as np
from fastapi import Path, Query
from pydantic import Field

from core.board.ensemble import Ensemble
from core.board.explain import Account, Turn, explain, last_turn, signals_of
from core.board.instances import scored
from core.board.spec import Section, Spec
from core.diagnose.aliases import AliasMap, AliasReport, alias_map, alias_report, hidden_um
from core.diagnose.hypothesis import Hypothesis, names_of
from core.diagnose.hypothesis import hypotheses_of as factors_of
from core.errors import InputError, unknown
from core.reference.waveform import Waveform
from server.api.bodies import Body
from server.api.deps import ServiceDep, SessionDep
from server.api.router import Router
from server.bench.bench import LiveBench
from server.bench.replay import Tape

router = Router(prefix="/benches/{bench_id}/diagnosers/{name}", tags=["diagnosers"])

Name = Annotated[str, Path(max_length=80, description="Id of the diagnoser; of a diagnoser on a twin: <twin>:<id>")]
Tick = Annotated[int | None, Query(ge=0, le=2**53, description="Tick of the sample; the last one unless given")]


class DriveTone(Body):
    """One tone of a drive."""

    frequency_hz: float = Field(gt=0, le=1e8)
    amplitude_v: float = Field(gt=0, le=1e4)


class AliasSource(Body):
    """Hypotheses and a drive; the defaults are the hypotheses of the diagnoser and the drive of the bench."""

    hypotheses: list[Hypothesis] | None = Field(
        None, min_length=2, max_length=16, description="Null: the hypotheses of the diagnoser"
    )
    tones: list[DriveTone] | None = Field(None, min_length=1, max_length=32, description="Null: the tones of the bench")
    within_um: float = Field(0.0, ge=0, le=1e6, description="Two responses that differ by less count as equal")


@router.get("/explain")
def explain_sample(session: SessionDep, name: str, tick: Tick = None) -> Account:
    """Work out how a sample changed every hypothesis: prior, residual, likelihood, posterior."""
    spec, section = spec_and_section(session, name)
    signals = signals_of(section)
    columns = session.indices([f"{name}.{signal}" for signal in signals])
    history = session.history
    first = history.first_tick
    asked = kept_tick(session, tick)
    turns = spec.turns(section)
    at = asked - asked % turns

    def read(sample: int) -> dict[str, float]:
        if sample < first:
            raise InputError("is the first one kept; explaining it takes the one before", "tick")
        values = history.read(columns, sample, sample + 1)[:, 0]
        if not np.all(np.isfinite(values)):
            raise InputError(f"what {name} thought at tick {sample} was not kept", "tick")
        return dict(zip(signals, map(float, values), strict=True))

    return explain(spec, section, at, read(at - turns) if at > 0 else None, read(at))


@router.get("/turn")
def find_turn(session: SessionDep, name: str, tick: Tick = None) -> Turn:
    """Find the sample up to this one at which the verdict last changed."""
    _, section = spec_and_section(session, name)
    if not scored(section.block):
        raise InputError(f"{section.block.name} has no verdict", "name")
    first, asked = session.history.first_tick, kept_tick(session, tick)
    winners = session.history.read(session.indices([f"{name}.winner"]), first, asked + 1)[0]
    return last_turn(names_of(section.params), winners, first)


@router.get("/aliases")
def map_bench_aliases(
    session: SessionDep,
    name: str,
    frequency_hz: Annotated[
        float | None,
        Query(gt=0, le=1e6, description="Frequency of one tone as large as the reference; left out: its own tones"),
    ] = None,
) -> AliasMap:
    """Map the response of every hypothesis to the tones of the drive, and name those with the same response."""
    spec, section = spec_and_section(session, name)
    context = spec.context()
    tones = [(frequency_hz, volts_of(spec))] if frequency_hz else tones_of(spec)
    if not tones:
        raise InputError("give one: the reference has no tone of its own", "frequency_hz")
    return alias_map(hypotheses_of(section), context.device, tones, hidden_um(context.sensor_noise_um))


@router.post("/aliases")
async def get_aliases(session: SessionDep, name: Name, body: AliasSource, service: ServiceDep) -> AliasReport:
    """Report the hypotheses of a list that look alike under the drive."""
    spec, section = spec_and_section(session, name)
    hypotheses = body.hypotheses or hypotheses_of(section)
    context = spec.context(spec.turns(section))
    tones = [(tone.frequency_hz, tone.amplitude_v) for tone in body.tones] if body.tones else tones_of(spec)
    if not tones:
        raise InputError("the reference has no tone of its own", "tones", "give the tones to look at")
    noise_um = context.sensor_noise_um
    return await service.computing.call(alias_report, hypotheses, context.device, tones, body.within_um, noise_um)


def kept_tick(session: LiveBench, tick: int | None) -> int:
    """Return the requested tick, or the last tick by default; an error if it is not kept."""
    first, end = session.history.first_tick, session.history.end_tick
    asked = end - 1 if tick is None else tick
    if not first <= asked < end:
        raise InputError(
            f"is not kept; the history has {first} to {end - 1}" if end > first else "nothing is kept", "tick"
        )
    return asked


def spec_and_section(session: LiveBench, name: str) -> tuple[Spec, Section]:
    """Return the bench a diagnoser is on, the first or a twin, and its section."""
    source = session.board
    board = cast(Ensemble, source.recorded_board if isinstance(source, Tape) else source)
    if name not in board.diagnosers:
        raise unknown("diagnoser", name, board.diagnosers, "name")
    twin = name.rpartition(":")[0]
    return (board.twins[twin] if twin else board).spec, board.diagnosers[name]


def hypotheses_of(section: Section) -> list[Hypothesis]:
    """Return the hypotheses of a diagnoser; an error if it has none."""
    hypotheses = factors_of(section.params)
    if not hypotheses:
        raise InputError(f"{section.block.name} has no hypotheses of one displacement", "name")
    return hypotheses


def tones_of(spec: Spec) -> list[tuple[float, float]]:
    """Return frequency in Hz and amplitude in V of the tones of the reference; none when it is broad."""
    return cast(type[Waveform], spec.reference.block).tones(spec.reference.params, spec.context())


def volts_of(spec: Spec) -> float:
    """Return the amplitude of the reference in V."""
    return float(cast(Any, spec.reference.params).volts(spec.context()))
