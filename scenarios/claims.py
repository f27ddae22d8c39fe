"""The claims of a scenario: the printed value, the expected value with its reason, and the measured value."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Literal

from pydantic import BaseModel, Field

from core.errors import InputError
from core.signals import Signal
from scenarios.expectation import Expectation, Verdict
from scenarios.printed import Kind, Printed
from scenarios.schema import Scenario

State = Literal["holds", "fails", "not yet"]


class Mark(BaseModel):
    """A printed number as it is drawn over a signal of a bench."""

    figure: str
    section: str
    words: str
    number: str = Field(description="The part of the words that is the number")
    reading: str = Field(description="How the drawn number follows from the words, where it is not in them")
    kind: Kind
    signal: str
    unit: str
    low: float | None
    high: float | None
    values: list[float]
    from_tick: int
    until_tick: int | None = Field(description="Null for the end of the run")
    problem: str = Field(description="Why it cannot be drawn on this bench")


class Claim(BaseModel):
    """An expectation of a scenario with the measured value."""

    metric: str
    published: str
    published_value: float | None
    printed_low: float | None = Field(description="Range in which a figure agrees with the text; null: open, or none")
    printed_high: float | None
    is_published: bool = Field(description="Whether the text says something that a figure is compared with")
    expected: str
    low: float | None = Field(description="Smallest value that counts as expected")
    high: float | None
    note: str
    reason: str
    fitted: list[str]
    measured: float | None = Field(description="Over the run so far")
    as_expected: bool | None = Field(description="Null without a measured value")
    state: State = Field(description="Of the printed claim; of the expectation where nothing is printed")
    verdict: Verdict | None = Field(description="Null until the run has come to its end")
    marks: list[Mark]


def claims(
    scenario: Scenario,
    metrics: Mapping[str, float],
    signals: Sequence[Signal],
    is_over: bool,
) -> list[Claim]:
    """Return the claims of a scenario.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    metrics : mapping
        Measured figures.
    signals : sequence of Signal
        Signals of the bench, for the printed marks.
    is_over : bool
        Whether the run has come to its end: before it nothing is ticked or crossed.
    """
    return [
        _claim(entry, metrics.get(entry.metric), marks(scenario, signals, entry.metric), is_over)
        for entry in scenario.head.expect
    ]


def holds(entry: Expectation, measured: float | None) -> bool:
    """Return whether a figure agrees with the printed value, or with the expected value where nothing is printed."""
    if entry.agreeing is None:
        return entry.holds(measured)
    low, high = entry.agreeing
    return measured is not None and low <= measured <= high


def marks(scenario: Scenario, signals: Sequence[Signal], metric: str | None = None) -> list[Mark]:
    """Return the marks that a bench can draw: all, or the marks of one metric; an empty name means no metric."""
    units = {signal.name: signal.unit for signal in signals}
    return [
        _mark(entry, scenario, units) for entry in scenario.head.printed if metric is None or entry.metric == metric
    ]


def check_marks(scenario: Scenario, signals: Sequence[Signal]) -> None:
    """Refuse marks that the bench of a scenario cannot draw, or that nothing judges.

    Raises
    ------
    InputError
        Naming the first of them.
    """
    units = {signal.name: signal.unit for signal in signals}
    for position, entry in enumerate(scenario.head.printed):
        field, problem = _problem(entry, scenario, units)
        if not problem and entry.metric and entry.metric not in [row.metric for row in scenario.head.expect]:
            field, problem = "metric", f"this scenario expects nothing of {entry.metric}"
        if problem:
            raise InputError(problem, f"printed.{position}.{field}")


def _mark(entry: Printed, scenario: Scenario, units: Mapping[str, str]) -> Mark:
    _, problem = _problem(entry, scenario, units)
    since = 0
    if entry.event is not None and not problem:
        since = scenario.events[entry.event][0].tick(scenario.spec.dt_ms) or 0
    first, last = entry.ticks(since, scenario.spec.dt_ms)
    said = entry.model_dump(
        include={"figure", "section", "words", "number", "reading", "signal", "unit", "low", "high"}
    )
    return Mark(**said, kind=entry.kind, values=entry.values, from_tick=first, until_tick=last, problem=problem)


def _problem(entry: Printed, scenario: Scenario, units: Mapping[str, str]) -> tuple[str, str]:
    """Return the field that is wrong with a mark, and why; nothing if it can be drawn."""
    unit, events = units.get(entry.signal), scenario.events
    if unit is None:
        return "signal", f"this bench has no signal {entry.signal}"
    if unit != entry.unit:
        return "unit", f"{entry.signal} is in {unit or 'no unit'}, the mark in {entry.unit or 'no unit'}"
    if entry.event is not None and entry.event >= len(events):
        return "event", f"there are {len(events)} events, counted from 0"
    if entry.event is not None and (events[entry.event][0].when or events[entry.event][0].tick(1.0) is None):
        return "event", "this event waits for a condition; take one at a moment"
    return "", ""


def _claim(entry: Expectation, measured: float | None, drawn: list[Mark], is_over: bool) -> Claim:
    low, high = entry.bounds()
    agreeing = entry.agreeing or (-math.inf, math.inf)
    state: State = "not yet"
    if is_over:
        state = "holds" if holds(entry, measured) else "fails"
    return Claim(
        **entry.model_dump(include={"metric", "published", "published_value", "note", "reason", "fitted"}),
        printed_low=_closed(agreeing[0]),
        printed_high=_closed(agreeing[1]),
        is_published=entry.agreeing is not None,
        expected=entry.words(),
        low=low,
        high=high,
        measured=measured,
        as_expected=None if measured is None else entry.holds(measured),
        state=state,
        verdict=entry.word(measured) if is_over else None,
        marks=drawn,
    )


def _closed(end: float) -> float | None:
    return end if math.isfinite(end) else None
