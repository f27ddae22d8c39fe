"""The bench with which a student begins: the scenario with the own device and numbers, and facts for formulas.

The same words give the same bench. All of it stays on the server until a step is done.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from core.device.spread import Tolerances, draw
from scenarios.design import device_figures
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.sheets.expression import evaluate
from scenarios.sheets.sheet import Sheet

DIGITS = 6
"""Decimals of the parts of a drawn device, in their own units."""
SEEDS = 1_000_000


@dataclass(frozen=True)
class Beginning:
    """The bench of a student, and the facts of it."""

    values: dict[str, Any]
    facts: dict[str, float]


def begin(sheet: Sheet, drawn: Callable[[str], int]) -> Beginning:
    """Draw the varying numbers of a student, and work out the facts.

    Parameters
    ----------
    sheet : Sheet
        The sheet.
    drawn : callable
        Gives a seed for a purpose, the same each time.
    """
    draws = {name: number.of(drawn(f"number {name}")) for name, number in sheet.head.draws.items()}
    bench = sheet.head.bench
    scenario = get(bench.scenario)
    values: dict[str, Any] = {"seed": drawn("noise") % SEEDS}
    if bench.drawn_device:
        geometry = with_values(scenario, _own(bench.set)).spec.device.drawing
        spread = draw(geometry, Tolerances(), 1, drawn("device"))
        values |= {f"device.geometry.{name}": round(float(x[0]), DIGITS) for name, x in spread.drawn.items()}
    values |= {path: _value(value, draws, f"bench.set.{path}") for path, value in bench.set.items()}
    spec = with_values(scenario, values).spec
    facts = {name: value for name, value in device_figures(spec).items() if "." not in name} | draws
    facts |= {"dt_ms": spec.dt_ms, "tone_hz": spec.tone_hz}
    for name, formula in sheet.head.numbers.items():
        facts[name] = evaluate(formula, facts, f"numbers.{name}")
    return Beginning(values, facts)


def _own(values: dict[str, Any]) -> dict[str, Any]:
    """Return the values that belong to the device."""
    return {path: value for path, value in values.items() if path.split(".")[0] == "device"}


def _value(value: Any, draws: dict[str, float], field: str) -> Any:
    """Return a value to set; a text that begins with ``=`` is a formula over the numbers drawn."""
    return evaluate(value[1:], draws, field) if isinstance(value, str) and value.startswith("=") else value
