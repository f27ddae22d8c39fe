"""Diagnosers of a live bench: one sample explained, and the hypotheses that look alike under the drive."""

from __future__ import annotations

from typing import Annotated, Any, cast

import numpy as np
from fastapi import Query

from core.board.ensemble import Ensemble
from core.board.explain import Account, Turn, explain, last_turn, signals_of
from core.board.instances import scored
from core.board.spec import Section, Spec
from core.diagnose.aliases import AliasMap, alias_map, hidden_um
from core.diagnose.hypothesis import Hypothesis, names_of
from core.diagnose.hypothesis import hypotheses_of as factors_of
from core.errors import InputError, unknown
from core.reference.waveform import Waveform
from server.api.deps import SessionDep
from server.api.router import Router
from server.bench.bench import LiveBench
from server.bench.replay import Tape

router = Router(prefix="/benches/{bench_id}/diagnosers/{name}", tags=["diagnosers"])


@router.get("/explain")
def explain_sample(
    session: SessionDep,
    name: str,
    tick: Annotated[int | None, Query(ge=0, le=2**53, description="The sample; the last one unless given")] = None,
) -> Account:
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
def find_turn(
    session: SessionDep,
    name: str,
    tick: Annotated[int | None, Query(ge=0, le=2**53, description="The sample; the last one unless given")] = None,
) -> Turn:
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
        float | None, Query(gt=0, le=1e6, description="One tone as large as the reference; those it has unless given")
    ] = None,
) -> AliasMap:
    """Map the response of every hypothesis to the tones of the drive, and name those with the same response."""
    spec, section = spec_and_section(session, name)
    context = spec.context()
    tones = [(frequency_hz, volts_of(spec))] if frequency_hz else tones_of(spec)
    if not tones:
        raise InputError("give one: the reference has no tone of its own", "frequency_hz")
    return alias_map(hypotheses_of(section), context.device, tones, hidden_um(context.sensor_noise_um))


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
