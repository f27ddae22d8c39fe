"""Looks at a bench at the end of a window: measures each condition of a step, and decides whether it holds."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, Protocol

import numpy as np

from core.block import FloatArray
from core.board.spec import Spec
from core.cards import parameter_cards
from core.errors import InputError, unknown
from core.format import format_short, format_si
from core.registry import block
from scenarios.measure.metrics import fundamental
from scenarios.sheets.expression import evaluate
from scenarios.sheets.sheet import Hold, Limits

Value = float | str | None
REFERENCE = "reference.voltage"


class Window(Protocol):
    """A bench over the last ticks of a window."""

    dt_ms: float

    @property
    def board(self) -> Any:
        """The board at the end."""

    def samples(self, signal: str) -> FloatArray:
        """Return a signal over the window."""


class Finding(NamedTuple):
    """The value of a condition, and whether it holds."""

    value: Value
    holds: bool


def look(step: Hold, limits: list[tuple[float, float] | None], window: Window) -> list[Finding]:
    """Measure every condition of a step."""
    found = []
    for condition, ends in zip(step.conditions, limits, strict=True):
        value = measure(condition, window)
        if condition.equals is not None:
            holds = value == condition.equals
        else:
            holds = ends is not None and isinstance(value, float) and ends[0] <= value <= ends[1]
        found.append(Finding(value, holds))
    return found


def signals_of(step: Hold) -> list[str]:
    """Return the signals that a step looks at or keeps a trace of."""
    named = [signal for condition in step.conditions for signal in (condition.signal, condition.over)]
    named += [REFERENCE for condition in step.conditions if condition.measure == "phase"]
    return list(dict.fromkeys(signal for signal in [*named, *step.trace] if signal is not None))


def limits_of(step: Hold, facts: Mapping[str, float]) -> list[tuple[float, float] | None]:
    """Return the ends between which each condition is to be, by the facts of a student."""
    found: list[tuple[float, float] | None] = []
    for position, condition in enumerate(step.conditions):
        if condition.between is None:
            found.append(None)
            continue
        field = f"conditions.{position}.between"
        low, high = (evaluate(end, facts, field) for end in condition.between)
        if low > high:
            raise InputError(f"{low:g} is above {high:g}", field)
        found.append((low, high))
    return found


def known_limits(step: Hold, facts: Mapping[str, float]) -> list[tuple[float, float] | None]:
    """Return the ends as `limits_of`; none at all, so that nothing holds, where one follows from a step left out."""
    try:
        return limits_of(step, facts)
    except InputError:
        return [None] * len(step.conditions)


def measure(condition: Limits, window: Window) -> Value:
    """Return the value of a condition."""
    board = window.board
    if condition.verdict is not None:
        score = board.scores().get(condition.verdict)
        if score is None or not score.samples or score.unexplained or not 0 <= score.winner < len(score.names):
            return None
        return str(score.names[score.winner])
    if condition.fault is not None:
        acting = board.faults.get(condition.fault)
        return 0.0 if acting is None else float(acting.severity)
    if condition.setting is not None:
        return setting_of(board.spec, condition.setting)
    assert condition.signal is not None
    value = _measured(condition.measure, condition.signal, window)
    if condition.over is not None:
        below = _measured(condition.measure, condition.over, window)
        return value / below if below else None
    return value if math.isfinite(value) else None


def setting_of(spec: Spec, path: str) -> float | str:
    """Return a setting of a bench as it is now, also a setting that was never written.

    Raises
    ------
    InputError
        When there is no such setting.
    """
    if path in ("controller.kind", "sensor.kind"):
        return spec.active if path == "controller.kind" else spec.measuring
    table, _, rest = path.partition(".")
    name, _, field = rest.partition(".")
    groups = {"controllers": spec.controllers, "diagnosers": spec.diagnosers, "identifiers": spec.identifiers}
    alone = {"reference": spec.reference, "plant": spec.plant, "environment": spec.environment, "model": spec.model}
    if table in alone:
        section, field = alone[table], rest
    else:
        group = {**groups, "sensors": spec.sensors}.get(table)
        if group is None:
            raise unknown("table", table, [*alone, *groups, "sensors"], "setting")
        if name not in group:
            raise unknown(table.removesuffix("s"), name, group, "setting")
        section = group[name]
    if field in ("kind", "model"):
        return section.block.name
    if field not in type(section.params).model_fields:
        raise unknown("field", field, type(section.params).model_fields, "setting")
    found = getattr(section.params, field)
    return float(found) if isinstance(found, int | float) and not isinstance(found, bool) else str(found)


def _measured(kind: str, signal: str, window: Window) -> float:
    x = window.samples(signal)
    if kind == "value":
        return float(x[-1])
    if kind == "mean":
        return float(np.mean(x))
    if kind == "rms":
        return float(np.sqrt(np.mean(x * x)))
    if kind == "peak":
        return float(np.max(np.abs(x)))
    if kind == "swing":
        return float(np.max(x) - np.min(x)) / 2.0
    if kind == "share":
        return float(np.mean(x != 0.0))
    tone = window.board.spec.tone_hz
    if not tone:
        return math.nan
    own = fundamental(x, tone, window.dt_ms)
    if kind == "amplitude":
        return abs(own)
    asked = fundamental(window.samples(REFERENCE), tone, window.dt_ms)
    return math.degrees(cmath.phase(own / asked)) if asked else math.nan


def wanted_text(condition: Limits, ends: tuple[float, float] | None) -> str:
    """Return the required value of a condition as text; empty if the sheet hides it."""
    if not condition.told:
        return ""
    if ends is None:
        return condition.equals or ""
    low, high = ends
    if low == high:
        return _text(condition, low)
    if low == 0.0 or high == 0.0 or abs(low) >= 1e9:
        return f"at most {_text(condition, high)}"
    if abs(high) >= 1e9:
        return f"at least {_text(condition, low)}"
    return f"{_text(condition, low)} to {_text(condition, high)}"


def value_text(condition: Limits, value: Value) -> str:
    """Write a measured value."""
    if value is None:
        return "–"
    return value if isinstance(value, str) else _text(condition, value, 3, format_si)


def _text(condition: Limits, value: float, digits: int = 4, write: Callable[..., str] = format_short) -> str:
    """Write a value in the unit of the condition; the severity of a fault in its own, a share of it in percent."""
    unit = condition.unit
    if condition.fault and not unit:
        parameters = parameter_cards(block("faults", condition.fault).Params)
        unit = next(one.unit for one in parameters if one.name == "severity")
    return write(100.0 * value, "%", digits) if unit == "1" else write(value, unit, digits)
