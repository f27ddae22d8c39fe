"""The parts of a new bench: its scenario, its board, the pace that suits it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, TypeGuard

from core.board.board import Board
from core.board.document import Document
from core.nesting import read_toml
from core.own.admission import check_admitted, kept_with
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.own import beside
from scenarios.run import build
from scenarios.schema import Scenario
from server.bench.commands import DEFAULT_SCALE, MAX_SCALE
from server.bench.tick_source import TickSource

AXES_SCALE = 0.1
"""Device seconds per wall second of a plant with axes."""


def prepare(
    source: str | dict[str, Any],
    values: dict[str, Any],
    seed: int | None,
    units: Callable[[Document], Document] | None = None,
    *,
    compiled: bool = True,
) -> tuple[Scenario, Board]:
    """Read a scenario, write values over it, give it those units of this server that are for it, wire its board."""
    document = _document(source)
    has_table = isinstance(document.get("units", {}), dict)  # else it is refused below
    if units and has_table and (given := units({**document, "set": values})):
        check_admitted(document)
        with kept_with(values):
            own = {**given, **document.get("units", {})}
            scenario = with_values(Scenario.load({**document, "units": own}), values)
            return scenario, build(scenario, seed, compiled=compiled)
    scenario = with_values(read_scenario(source), values)
    return scenario, build(scenario, seed, compiled=compiled)


def check(source: str | dict[str, Any], values: dict[str, Any], units: Document) -> None:
    """Refuse a scenario that makes no bench; nothing is compiled.

    Parameters
    ----------
    source : str or dict
        A document, a library id, or a TOML text.
    values : dict
        Written over it.
    units : dict
        Units of this server, in addition to the document's own.
    """
    prepare(source, values, None, partial(beside, units), compiled=False)


def read_scenario(source: str | dict[str, Any]) -> Scenario:
    """Read a scenario: a document, a library id, or a TOML text (which has an equals sign)."""
    return get(source) if is_id(source) else Scenario.load(source)


def _document(source: str | dict[str, Any]) -> Document:
    """Return a scenario as it was written."""
    if isinstance(source, dict):
        return source
    return get(source).document if is_id(source) else read_toml(source, "scenario")


def is_id(source: str | dict[str, Any]) -> TypeGuard[str]:
    """Say whether a scenario is named by its id in the library."""
    return isinstance(source, str) and "=" not in source and "\n" not in source


def usual_scale(board: TickSource) -> float:
    """Return the time scale that suits a device.

    The scale of a resonator; near real time for a plant in seconds; between them for a plant with axes, whose amplitude
    and rate take some hundred periods to settle.
    """
    if board.spec.axes:
        return AXES_SCALE
    return min(MAX_SCALE, DEFAULT_SCALE * max(1.0, board.spec.device.oscillator().time_unit_ms))
