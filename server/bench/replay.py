"""Replays: a bench plays a recording in the place of a board. It takes the commands to time and refuses changes."""

from __future__ import annotations

import json
from collections.abc import Collection
from concurrent.futures import Future
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from core.board.board import Board
from core.board.document import Document
from core.board.kept import Ticks
from core.board.log import LogEntry
from core.board.pending import PendingQueue
from core.board.rows import Rows
from core.board.spec import Section, Spec
from core.errors import InputError
from core.own.admission import kept
from core.signals import Signal, SignalTable
from scenarios.arrow import pq
from scenarios.narrator.narrator import Narrator
from scenarios.narrator.sentence import Sentence
from scenarios.run import build
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.commands import DEFAULT_SCALE, Loop, Reset, RunsTime, Seek, Start
from server.bench.events import Event
from server.bench.narration import Narration
from server.bench.time import DeviceTime
from server.errors import ApiError
from server.metrics import Metrics
from server.store.recording import first_tick
from server.store.recordings import RecordingDetail

REFUSAL = "this bench plays a recording"
RECORDED = ("tick", "actor", "kind", "text", "command", "old", "new")
"""Fields of an event that a recording has."""
LEAST_LOOP = 100
"""Ticks of the shortest span that can be looped."""


class Tape:
    """Takes the place of a board and advances by reading a recording.

    Parameters
    ----------
    board : Board
        Built from the scenario of the recording; gives its signals and blocks.
    path : Path
        The file of the recording.
    only : collection of str, optional
        Reads these signals alone.
    """

    def __init__(self, board: Board, path: Path, only: Collection[str] | None = None) -> None:
        self._board = board
        self._file = pq.ParquetFile(path)
        recorded = set(self._file.schema_arrow.names)
        names = [signal.name for signal in board.signals]
        self._columns = [(at, name) for at, name in enumerate(names) if name in recorded]
        if only is not None:
            self._columns = [(at, name) for at, name in self._columns if name in only]
        if not self._columns:
            raise InputError("has no signal this version knows", "recording")
        self._width, self._outputs = len(names), board.signals.outputs
        self.first = self.tick = first_tick(path)
        self.end = self.first + self._file.metadata.num_rows
        sizes = [self._file.metadata.row_group(i).num_rows for i in range(self._file.num_row_groups)]
        self._edges = self.first + np.concatenate([[0], np.cumsum(sizes)])
        self._group: tuple[int, NDArray[np.float32]] | None = None
        self.log = board.log
        self.trip = None
        self.pending = PendingQueue()
        self.faults: dict[str, Any] = {}

    @property
    def recorded(self) -> list[Signal]:
        """The signals of the board that were recorded."""
        return [self._board.signals[at] for at, _ in self._columns]

    @property
    def recorded_board(self) -> Board:
        """The board the recording was made with, at its first tick."""
        return self._board

    @property
    def chunk(self) -> int:
        """Most ticks of one call of ``advance``."""
        return self._board.chunk

    @property
    def dt_ms(self) -> float:
        """Sample interval, ms."""
        return self._board.dt_ms

    @property
    def spec(self) -> Spec:
        """The blocks and their parameters."""
        return self._board.spec

    @property
    def base(self) -> Document:
        """The document the board was made from."""
        return self._board.base

    @property
    def signals(self) -> SignalTable:
        """Table of traced signals."""
        return self._board.signals

    @property
    def diagnosers(self) -> dict[str, Section]:
        """Every diagnoser by its id."""
        return self._board.diagnosers

    def advance(self, n: int) -> Rows:
        """Read up to ``n`` ticks, to the end of the recording or of a piece of its file."""
        count = min(n, self._board.chunk, self.end - self.tick)
        if count <= 0:
            return self._rows(np.zeros((0, self._width), np.float32))
        number = int(np.searchsorted(self._edges, self.tick, "right")) - 1
        samples = self._read(number)
        start = self.tick - int(self._edges[number])
        rows = self._rows(samples[start : start + count])
        self.tick += rows.count
        return rows

    def seek(self, tick: int) -> None:
        """Go to a tick of the recording."""
        if not self.first <= tick < self.end:
            raise InputError(f"the recording has ticks {self.first} to {self.end - 1}", "tick")
        self.tick = tick

    def scores(self) -> dict[str, Any]:
        """Return nothing: scores are among the signals."""
        return {}

    def digest(self) -> str:
        """Return nothing: the recorded values are rounded."""
        return ""

    def apply(self, *_: Any) -> NoReturn:
        """Refuse: a recording cannot be changed."""
        raise InputError(REFUSAL, "command", "run its scenario to change something", "conflict")

    def checkpoint(self) -> NoReturn:
        """Refuse: a recording has no state of a board."""
        raise InputError(REFUSAL, "bench", "run its scenario to branch off", "conflict")

    save = checkpoint

    def _read(self, number: int) -> NDArray[np.float32]:
        """Return a row group as ``(ticks, signals)``; signals that were not recorded are NaN."""
        if self._group is None or self._group[0] != number:
            table = self._file.read_row_group(number, columns=[name for _, name in self._columns])
            samples = np.full((table.num_rows, self._width), np.nan, np.float32)
            for at, name in self._columns:
                samples[:, at] = table.column(name).to_numpy()
            self._group = number, samples
        return self._group[1]

    def _rows(self, samples: NDArray[np.float32]) -> Rows:
        return Rows.of(self.tick, samples, self._outputs)


TickSource = Board | Tape
"""A live bench advances one of these: a board computes its ticks, a tape reads them from a recording."""


def narrated(tape: Tape, path: Path, events: list[dict[str, Any]]) -> list[Sentence]:
    """Return the sentences of the narrator about a recording, made from its samples and its events."""
    narrator = Narrator(tape.spec, tape.recorded)
    for number, event in enumerate(events, 1):
        narrator.hear(LogEntry(seq=number, **event))
    own, found = Tape(tape.recorded_board, path, narrator.signals), []
    while (rows := own.advance(own.chunk)).count:
        found += narrator.look(rows)
    return found


def played(recording: RecordingDetail, path: Path) -> tuple[Scenario, Tape, float]:
    """Return the scenario of a recording, its tape, and the device seconds per wall second it was recorded at.

    Raises
    ------
    ApiError
        If this version cannot read its scenario.
    """
    try:
        with kept():
            scenario = Scenario.load(recording.scenario or {})
            tape = Tape(build(scenario), path)
    except InputError as error:
        text = f"this version cannot play it: {error}"
        raise ApiError(409, "conflict", text, hint="its trace can be downloaded") from None
    about = json.loads((pq.read_schema(path).metadata or {}).get(b"combbench", b"{}"))
    return scenario, tape, about.get("time_scale") or DEFAULT_SCALE


class Playing(DeviceTime):
    """How a recording plays: from any tick, to its end or a span of it again and again.

    Parameters
    ----------
    bench : LiveBench
        The bench that plays it.
    tape : Tape
        The recording.
    time_scale : float
        Device seconds per wall second.
    metrics : Metrics
        Where overruns are counted.
    """

    def __init__(self, bench: LiveBench, tape: Tape, time_scale: float | None, metrics: Metrics) -> None:
        super().__init__(bench, time_scale, tape.end, metrics)
        self._tape = tape
        self._loop_start: int | None = None

    def carry_out(self, command: RunsTime, actor: str) -> Event | Future[Event]:
        """Carry out a command to time; only a replay can seek and loop, and a reset goes to its first tick."""
        tape = self._tape
        if isinstance(command, Reset):
            if command.values:
                raise InputError(REFUSAL, "values", "run its scenario to change something", "conflict")
            command = Seek(tick=tape.first if command.before_tick is None else command.before_tick)
        if isinstance(command, Seek):
            tape.seek(command.tick)
            self._jump()
            return self._bench.note(actor, "seek", f"went to tick {command.tick}", command.model_dump())
        if isinstance(command, Loop):
            return self._set_loop(command, actor)
        if isinstance(command, Start) and tape.tick >= tape.end:
            tape.seek(tape.first)
            self._jump()
        return super().carry_out(command, actor)

    def _set_loop(self, command: Loop, actor: str) -> Event:
        """Play a span again and again, or to the end."""
        tape = self._tape
        if command.start_tick is None and command.end_tick is None:
            self._loop_start, self.ends_at = None, tape.end
            return self._bench.note(actor, "loop", "plays to the end", command.model_dump())
        start = tape.first if command.start_tick is None else command.start_tick
        end = tape.end if command.end_tick is None else command.end_tick
        if not tape.first <= start < end <= tape.end or end - start < LEAST_LOOP:
            text = f"must be within {tape.first} to {tape.end} and have at least {LEAST_LOOP} ticks"
            raise InputError(text, "end_tick")
        had_ended = tape.tick >= tape.end
        self._loop_start, self.ends_at = start, end
        if not start <= tape.tick < end:
            tape.seek(start)
            self._jump()
        text = f"plays ticks {start} to {end} again and again"
        done = self._bench.note(actor, "loop", text, command.model_dump())
        if had_ended:  # a replay that stopped at its end continues; a replay that a user paused stays paused
            self.carry_out(Start(), actor)
        return done

    def _jump(self) -> None:
        """Let history and clock follow the tape."""
        self.steps.end()
        if not self._bench.rewind():
            self._bench.begin_history()
        if self.ends_at is None:
            self.ends_at = self._tape.end
        self._anchor()

    def _finish(self) -> None:
        """Begin the span again, or stop at the end."""
        if self._loop_start is not None:
            self._tape.seek(self._loop_start)
            self._jump()
        else:
            super()._finish()


class Transcript(Narration):
    """The sentences of the narrator about a whole recording; playing it adds nothing."""

    def hear(self, event: Event) -> None:
        """Leave it as it is."""

    def look(self, rows: Ticks) -> None:
        """Leave it as it is."""


def play(bench: LiveBench, tape: Tape, recording: RecordingDetail, path: Path, metrics: Metrics) -> None:
    """Let a bench around a tape play its recording, with the recorded events and the sentences about them."""
    events = [{name: event.get(name) for name in RECORDED} for event in recording.events or []]
    bench.replay_of = recording.id
    bench.time = Playing(bench, tape, bench.time.pacer.scale, metrics)
    bench.narration = Transcript(tape.spec, [])
    bench.narration.say(narrated(tape, path, events))
    for event in events:
        bench.events.keep(**event)
