"""A student as the teacher's grid shows one: the bench in a few numbers and a small trace."""

from __future__ import annotations

from datetime import datetime

import numpy as np
from pydantic import BaseModel, Field

from core.loop.score import Scores
from server.bench.bench import LiveBench
from server.bench.description import factors_of
from server.bench.status import ActiveFault, State
from server.classroom.blinds import Answer
from server.classroom.sheet_work import SheetBrief
from server.security.person import Person

COLUMNS = 48
SPAN_MS = 4.0
"""Content of the small trace: this span of device time, minima and maxima of each column."""
SHOWN = ("plant.displacement", "plant.x")


class Verdict(BaseModel):
    """The verdict of a diagnoser, and the truth."""

    diagnoser: str
    says: str | None
    truth: str | None
    correct_fraction: float
    factors: dict[str, dict[str, float]] = Field(description="How these two differ from the nominal device")


class Tile(BaseModel):
    """A student and the bench, in brief."""

    id: str
    name: str
    hand: bool
    bench: str | None = Field(description="Null until the student's page has asked for it")
    watchers: int = Field(description="Pages that show the bench, or that the student has open")
    until: datetime | None
    scenario: str = ""
    state: State | None = None
    time_ms: float = 0.0
    controller: str = ""
    faults: list[ActiveFault] = []
    verdicts: list[Verdict] = []
    blind: Answer | None = Field(None, description="The last hidden fault, and the answer")
    sheet: SheetBrief | None = Field(None, description="The lab sheet begun last")
    trace: list[tuple[float, float]] = Field([], description="Minimum and maximum of the displacement, um, by column")


def tile_of(person: Person, bench: LiveBench | None, watchers: int, *, hand: bool) -> Tile:
    """Show a student."""
    tile = Tile(id=person.id, name=person.name, hand=hand, bench=None, watchers=watchers, until=person.until)
    if bench is None:
        return tile
    status = bench.status
    return tile.model_copy(
        update={
            "bench": bench.id,
            "scenario": bench.scenario.head.title or bench.scenario.id,
            "state": status.state,
            "time_ms": status.tick * bench.dt_ms,
            "controller": status.controller,
            "faults": status.faults,
            "verdicts": [
                _verdict(name, score, factors_of(bench.board.diagnosers[name])) for name, score in status.scores.items()
            ],
            "trace": _trace(bench),
        }
    )


def _verdict(diagnoser: str, score: Scores, factors: list[dict[str, float]]) -> Verdict:
    """Return the verdict of a diagnoser, with the truth."""

    def named(index: int) -> str | None:
        return score.names[index] if 0 <= index < len(score.names) else None

    says, truth = None if score.unexplained else named(score.winner), named(score.truth)
    told = {name: found for name, found in zip(score.names, factors, strict=False) if name in (says, truth)}
    return Verdict(diagnoser=diagnoser, says=says, truth=truth, correct_fraction=score.correct_fraction, factors=told)


def _trace(bench: LiveBench) -> list[tuple[float, float]]:
    """Return the end of the displacement."""
    shown = [name for name in SHOWN if name in bench.column_of]
    history = bench.history
    end = history.end_tick
    start = max(history.first_tick, end - round(SPAN_MS / bench.dt_ms))
    if not shown or end - start < COLUMNS:
        return []
    low, high = history.columns(bench.indices(shown[:1]), start, end, COLUMNS)[0]
    known = np.isfinite(low) & np.isfinite(high)
    return [(round(float(a), 5), round(float(b), 5)) for a, b in zip(low[known], high[known], strict=True)]
