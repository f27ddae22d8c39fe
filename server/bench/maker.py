"""Puts benches around boards and recordings; they are not published yet."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from core.board.board import Board
from core.board.history import History
from scenarios.schema import Scenario
from server.bench.commands import MAX_SCALE, MIN_SCALE
from server.bench.replay import Replay, narrated, played
from server.bench.session import STUDENT_CAPTURE_BYTES, STUDENT_TRACK_BYTES, Session
from server.bench.tick_source import TickSource
from server.bench.timeline import CAPTURE_BYTES, TRACK_BYTES
from server.metrics import Metrics
from server.settings import Settings
from server.store.recordings import RecordingDetail
from server.store.units import FOLDER, Units


class Maker:
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

    def around(self, scenario: Scenario, board: Board, time_scale: float | None, class_id: str = "") -> Session:
        """Put a bench around a board; one for a student of a class has less room for its history."""
        if class_id:
            kept = self._kept(board, self._settings.student_history_mb, STUDENT_TRACK_BYTES + 2 * STUDENT_CAPTURE_BYTES)
        else:
            kept = self._kept(board, self._settings.history_mb, TRACK_BYTES + 2 * CAPTURE_BYTES)
        session = Session(scenario, board, time_scale, kept, self._metrics, self._clock)
        if class_id:
            session.belong(class_id, self._settings.student_ticks_per_s)
        return session

    def replay(self, recording: RecordingDetail, path: Path, speed: float) -> Session:
        """Make a bench that plays a recording, at a multiple of the pace it was recorded at.

        Raises
        ------
        ApiError
            If this version cannot read its scenario.
        """
        scenario, tape, recorded = played(recording, path)
        pace = min(max(recorded * speed, MIN_SCALE), MAX_SCALE)
        kept = self._kept(tape, self._settings.history_mb, 2 * CAPTURE_BYTES)
        said = narrated(tape, path, recording.events or [])
        session = Replay(recording, scenario, tape, pace, kept, self._metrics, self._clock, said)
        session.recorded_scale = recorded
        return session

    def _kept(self, board: TickSource, megabytes: int, beside_bytes: int) -> int:
        """Return for how many ticks the signals of a board are kept, in addition to the other memory of its past."""
        affordable = History.ticks_within(
            megabytes - beside_bytes * 1e-6, board.signals.outputs, len(board.signals.taps)
        )
        return min(self._settings.history_ticks, affordable)
