"""A crash in mid-sheet: what is found is what would have been found without it, bit for bit."""

from __future__ import annotations

import json
import random
import signal
import time
from pathlib import Path
from typing import Any

import pytest

from core.board.stored import Stored, revived, stored
from server.bench.timeline import Timeline
from server.bench.watch import KeptWatch
from server.people.sheet_watch import SheetWatch
from tests.server.people.offline import Offline
from tests.server.people.test_sheet_lessons import LESSONS
from tests.server.people.test_sheets import OWN
from tests.server.people.test_survival import Process


class Crashing(Offline):
    """Somebody at a sheet whose server crashes now and then, and comes back from what it has kept."""

    crashes = 0

    def __init__(self, sheet: str, word: str, chance: random.Random) -> None:
        self._chance = chance
        super().__init__(sheet, word)

    def run(self, ms: float) -> None:
        if self._chance.random() < 0.5:
            return super().run(ms)
        ticks = round(ms / self.line.dt_ms)
        before = self._chance.randint(0, ticks)
        super().run(before * self.line.dt_ms)
        self.crash()
        super().run((ticks - before) * self.line.dt_ms)

    def crash(self) -> None:
        kept = self.watch.kept(self.line) if self.watch is not None else None  # type: ignore[arg-type]
        board = stored(self.line.board)  # type: ignore[arg-type]
        again = revived(Stored(json.loads(json.dumps(board.document)), board.arrays))
        self.line = Timeline(self.line.scenario, again, 100_000, time.perf_counter)
        self.watch = None
        self.follow()
        if kept is not None and self.watch is not None:
            self.watch.go_on(KeptWatch(json.loads(json.dumps(kept.document)), kept.samples))
        self.crashes += 1


@pytest.mark.parametrize("name", ["first-look", "resonance-and-q", "kalman-and-noise"])
def test_a_sheet_with_crashes_is_found_as_one_without(name: str) -> None:
    calm, shaken = Offline(name, "Ada"), Crashing(name, "Ada", random.Random(name))
    for at in (calm, shaken):
        LESSONS[name](at)
    assert shaken.crashes > 5
    assert shaken.progress.model_dump() == calm.progress.model_dump()
    assert any(step.trace for step in calm.progress.steps.values())


def test_what_was_found_and_not_written_is_told_again() -> None:
    told: list[Any] = []
    at = Offline("first-look", "Ada")
    watch = at.watch
    assert watch is not None
    watch._done = told.append
    at.run(20.0)
    kept = watch.kept(at.line)  # type: ignore[arg-type]
    again = SheetWatch(watch.step, [], 0, at.line.dt_ms, told.append)
    again.go_on(KeptWatch(json.loads(json.dumps(kept.document)), kept.samples))
    again.look(at.line)  # type: ignore[arg-type]
    assert len(told) == 2 and told[0] == told[1] and told[0].trace
    SheetWatch(watch.step.model_copy(update={"id": "other"}), [], 0, at.line.dt_ms, told.append).go_on(kept)
    assert len(told) == 2


def test_a_step_goes_on_where_it_was_after_a_kill(tmp_path: Path) -> None:
    server = Process(tmp_path)
    sheet = server.ask("POST", "/api/v1/sheets", json={"text": OWN})["id"]
    group = server.ask("POST", "/api/v1/classes", json={"name": "Tuesday"})
    joined = {"code": group["code"], "name": "Ada"}
    ada = server.ask("POST", f"/api/v1/classes/{group['id']}/join", json=joined)["session"]
    view = server.ask("POST", f"/api/v1/sheets/{sheet}/begin", ada)
    commands = f"/api/v1/benches/{view['bench']}/commands"

    def step(ticks: int) -> dict[str, Any]:
        server.ask("POST", commands, ada, json={"kind": "step", "ticks": ticks})
        found: dict[str, Any] = server.ask("GET", f"/api/v1/sheets/{sheet}", ada)["sections"][0]["step"]
        return found

    server.ask("POST", commands, ada, json={"kind": "pause"})
    server.ask("POST", commands, ada, json={"kind": "reset"})
    volts = float(view["sections"][0]["text"].split("Set ")[1].split("\u00a0")[0])
    server.ask("POST", commands, ada, json={"set": {"reference.amplitude_v": volts}})
    before = step(120)  # two windows of 50 ticks and a part of the third
    assert before["held_share"] == 0.5
    time.sleep(1.5)  # checkpoints are at most a second old
    server.end(signal.SIGKILL)

    server = Process(tmp_path)
    try:
        assert server.ask("GET", f"/api/v1/sheets/{sheet}", ada)["sections"][0]["step"] == before
        assert step(30)["held_share"] == 0.75  # the third window began before the crash
        assert step(49)["earned"] == 0.0 and step(1)["earned"] == 1.0
        view = server.ask("GET", f"/api/v1/sheets/{sheet}", ada)
        assert view["earned"] == 1.0 and view["sections"][1]["state"] == "open"
    finally:
        server.end(signal.SIGTERM)
