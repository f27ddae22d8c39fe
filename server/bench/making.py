"""The parts of a new bench: its scenario, its board, the pace that suits it."""

from __future__ import annotations

from typing import Any

from core.board.board import Board
from core.board.document import Document
from core.own.admission import kept
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.schema import Scenario
from server.bench.commands import DEFAULT_SCALE, MAX_SCALE
from server.bench.tick_source import TickSource

AXES_SCALE = 0.1
"""Device seconds per wall second of a plant with axes."""


def prepare(
    source: str | dict[str, Any], values: dict[str, Any], seed: int | None, units: Document | None = None
) -> tuple[Scenario, Board]:
    """Read a scenario, write values over it, give it the units of this server that it has not, wire its board."""
    scenario = with_values(read_scenario(source), values)
    if units:
        with kept():
            own = {**units, **scenario.document.get("units", {})}
            scenario = Scenario.load({**scenario.document, "units": own}, like=scenario)
    return scenario, build(scenario, seed)


def read_scenario(source: str | dict[str, Any]) -> Scenario:
    """Read a scenario: a document, a library id, or a TOML text (which has an equals sign)."""
    if isinstance(source, dict):
        return Scenario.load(source)
    if "=" in source or "\n" in source:
        return Scenario.load(source)
    return get(source)


def usual_scale(board: TickSource) -> float:
    """Return the time scale that suits a device.

    That of a resonator; near real time for a plant in seconds; between them for a plant with axes, whose amplitude and
    rate take some hundred periods to settle.
    """
    if board.spec.axes:
        return AXES_SCALE
    return min(MAX_SCALE, DEFAULT_SCALE * max(1.0, board.spec.device.oscillator().time_unit_ms))
