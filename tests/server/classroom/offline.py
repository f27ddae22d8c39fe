"""A sheet worked at without a server: the same steps, watch and points over a board that runs at full speed."""

from __future__ import annotations

from typing import Any

from core.board.commands import parse_command
from scenarios import sheets
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.sheets.begin import begin
from scenarios.sheets.look import limits_of
from scenarios.sheets.progress import Progress
from scenarios.sheets.sheet import Hold
from server.bench.bench import LiveBench
from server.classroom.draw import draw
from server.classroom.sheet_view import view_of
from server.classroom.sheet_watch import SheetWatch
from server.clock import ManualClock
from server.metrics import Metrics
from tests.server.classroom.at_sheet import AtSheet


class Offline(AtSheet):
    """A student at a sheet, as `AtSheet`; a word draws the numbers."""

    def __init__(self, sheet: str, word: str) -> None:
        self.lesson = sheets.get(sheet)
        beginning = begin(self.lesson, lambda what: draw(word, sheet, what))
        self.facts, self.progress = beginning.facts, Progress(facts=dict(beginning.facts))
        scenario = with_values(get(self.lesson.head.bench.scenario), beginning.values)
        self.line = LiveBench(scenario, build(scenario), None, 100_000, Metrics(), ManualClock())
        self.watch: SheetWatch | None = None
        self.follow()

    def follow(self) -> None:
        step = self.progress.open_step(self.lesson)
        if not isinstance(step, Hold):
            self.watch = None
        elif self.watch is None or self.watch.step is not step:

            def done(found: Any) -> None:
                self.progress.held(step, found.values, found.trace, found.tick)

            limits = limits_of(step, self.progress.facts)
            self.watch = SheetWatch(step, limits, self.line.board.tick, self.line.dt_ms, done)

    def do(self, **command: Any) -> None:
        self.line.board.apply(parse_command(command))  # type: ignore[attr-defined]

    def run(self, ms: float) -> None:
        end = self.line.board.tick + round(ms / self.line.dt_ms)
        while (left := end - self.line.board.tick) > 0:
            room = left if self.watch is None else self.watch.room(self.line.board.tick, left)
            rows = self.line._advance(room)
            assert rows.count, self.line.board.trip
            if self.watch is not None:
                self.watch.look(self.line)
                self.follow()

    def look(self) -> dict[str, Any]:
        held = self.watch.now if self.watch is not None else None
        self.view = view_of(self.lesson, self.progress, "bench", held).model_dump()
        return self.view

    def answer(self, name: str, text: str) -> dict[str, Any]:
        self.progress.answer(self.lesson, name, text, self.line.board.tick)
        self.follow()
        return self.step(name)

    @property
    def kept(self) -> Progress:
        return self.progress

    @property
    def device(self) -> dict[str, float]:
        return self.facts
