"""New benches: their scenario, their board, and the pace and the memory that suit them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, TypeGuard

from core.board.board import Board
from core.board.document import Document
from core.board.history import History
from core.errors import InputError
from core.nesting import read_toml
from core.own.admission import check_admitted, kept_with
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.own import beside
from scenarios.run import build
from scenarios.schema import Scenario
from server.bench.bench import OF_STUDENT, USUAL, BenchMemory, LiveBench
from server.bench.commands import MAX_SCALE, MIN_SCALE
from server.bench.replay import TickSource, play, played
from server.errors import ApiError
from server.metrics import Metrics
from server.settings import Settings
from server.store.experiment import Experiment
from server.store.recordings import RecordingDetail
from server.store.units import FOLDER, Units


class Builder:
    """Makes benches within the limits of the settings.

    Parameters
    ----------
    settings : Settings
        Limits.
    metrics : Metrics
        Where the benches count their ticks.
    clock : callable
        The engine's clock.
    """

    def __init__(self, settings: Settings, metrics: Metrics, clock: Callable[[], float]) -> None:
        self._settings, self._metrics, self._clock = settings, metrics, clock
        self.units = Units(settings.data / FOLDER, settings.unit_files)
        """Units that every new bench has in addition to the library's."""

    def around(self, scenario: Scenario, board: Board, time_scale: float | None, class_id: str = "") -> LiveBench:
        """Put a bench around a board; one for a student of a class has less room for its history."""
        settings, memory = self._settings, OF_STUDENT if class_id else USUAL
        kept = self._kept(board, settings.student_history_mb if class_id else settings.history_mb, memory)
        session = LiveBench(scenario, board, time_scale, kept, self._metrics, self._clock, memory)
        if class_id:
            session.class_id, session.keep = class_id, True
            session.time.limit(settings.student_ticks_per_s * board.dt_ms * 1e-3)
        return session

    def replay(self, recording: RecordingDetail, path: Path, speed: float) -> LiveBench:
        """Make a bench that plays a recording, at a multiple of the pace it was recorded at.

        Raises
        ------
        ApiError
            If this version cannot read its scenario.
        """
        scenario, tape, recorded = played(recording, path)
        pace = min(max(recorded * speed, MIN_SCALE), MAX_SCALE)
        kept = self._kept(tape, self._settings.history_mb, USUAL._replace(track_bytes=0))
        session = LiveBench(scenario, tape, pace, kept, self._metrics, self._clock)
        play(session, tape, recording, path, self._metrics)
        session.recorded_scale = recorded
        return session

    def _kept(self, board: TickSource, megabytes: int, memory: BenchMemory) -> int:
        """Return for how many ticks the signals of a board are kept, in addition to the other memory of its past."""
        left = megabytes - (memory.track_bytes + 2 * memory.capture_bytes) * 1e-6
        affordable = History.ticks_within(left, board.signals.outputs, len(board.signals.taps))
        return min(self._settings.history_ticks, affordable)


def prepare(
    source: str | dict[str, Any],
    values: dict[str, Any],
    seed: int | None,
    units: Callable[[Document], Document] | None = None,
    *,
    compiled: bool = True,
) -> tuple[Scenario, Board]:
    """Read a scenario, write values over it, give it those units of this server that are for it, wire its board."""
    document = read_document(source)
    has_table = isinstance(document.get("units", {}), dict)  # else it is refused below
    if units and has_table and (given := units({**document, "set": values})):
        check_admitted(document)
        with kept_with(values):
            own = {**given, **document.get("units", {})}
            scenario = with_values(Scenario.load({**document, "units": own}), values)
            return scenario, build(scenario, seed, compiled=compiled)
    scenario = with_values(read_scenario(source), values)
    return scenario, build(scenario, seed, compiled=compiled)


def rebuilt(experiment: Experiment, most_ticks: int, values: dict[str, Any] | None = None) -> tuple[Scenario, Board]:
    """Return the scenario of an experiment, and its board at tick 0 with all that was done waiting.

    ``values`` are written over the scenario.

    Raises
    ------
    InputError
        If the values do not fit the scenario or the commands.
    ApiError
        If it is longer than may be repeated, or this version cannot read it.
    """
    if experiment.tick > most_ticks:
        text = f"it has run for {experiment.tick} ticks; at most {most_ticks} are repeated (max_run_ticks)"
        raise ApiError(409, "too_long", text, hint="open its scenario instead, from tick 0")
    values = values or {}
    try:
        with kept_with(values):
            scenario = with_values(Scenario.load(experiment.scenario), values)
            return scenario, build(Scenario.load({**scenario.document, "events": experiment.events}))
    except InputError as error:
        if values:
            raise
        text = f"this version cannot repeat it: {error}"
        raise ApiError(409, "conflict", text, hint=f"it was made with {experiment.version}") from None


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


def read_document(source: str | dict[str, Any]) -> Document:
    """Return a scenario as it was written."""
    if isinstance(source, dict):
        return source
    return get(source).document if is_id(source) else read_toml(source, "scenario")


def is_id(source: str | dict[str, Any]) -> TypeGuard[str]:
    """Say whether a scenario is named by its id in the library."""
    return isinstance(source, str) and "=" not in source and "\n" not in source
