"""A crash in mid-sheet: the results equal the results without it, bit for bit."""

from __future__ import annotations

import json
import random
from typing import Any

import pytest

from core.board.stored import Stored, revived, stored
from server.bench.bench import LiveBench
from server.bench.view import KeptWatch
from server.classroom.sheet_watch import SheetWatch
from server.clock import ManualClock
from server.metrics import Metrics
from tests.server.classroom.group import Somebody, advance, join, open_class
from tests.server.classroom.offline import Offline
from tests.server.classroom.test_sheet_lessons import LESSONS
from tests.server.classroom.test_sheets import OWN
from tests.server.classroom.test_survival import LEFT_OR_KILLED, Servers


class Crashing(Offline):
    """A student at a sheet whose server crashes again and again, and continues from its checkpoint."""

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
        kept = self.watch.kept(self.line) if self.watch is not None else None
        board = stored(self.line.board)  # type: ignore[arg-type]
        again = revived(Stored(json.loads(json.dumps(board.document)), board.arrays))
        self.line = LiveBench(self.line.scenario, again, None, 100_000, Metrics(), ManualClock())
        self.watch = None
        self.follow()
        if kept is not None and self.watch is not None:
            self.watch.go_on(KeptWatch(json.loads(json.dumps(kept.document)), kept.samples))
        self.crashes += 1


@pytest.mark.parametrize(
    "name", ["first-look", "kalman-and-noise", pytest.param("resonance-and-q", marks=pytest.mark.long)]
)
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


@pytest.mark.parametrize("servers", LEFT_OR_KILLED, indirect=True)
def test_a_step_goes_on_where_it_was_after_a_kill(servers: Servers) -> None:
    first, second = servers

    def step(ada: Somebody, ticks: int) -> dict[str, Any]:
        command = {"kind": "step", "ticks": ticks}
        assert ada.ask("POST", f"/api/v1/benches/{ada.bench}/commands", json=command).is_success
        found: dict[str, Any] = ada.ask("GET", sheet).json()["sections"][0]["step"]
        return found

    with first as live:
        sheet = f"/api/v1/sheets/{live.http.post('/api/v1/sheets', json={'text': OWN}).json()['id']}"
        ada = join(live, open_class(live), "Ada")
        view = ada.ask("POST", f"{sheet}/begin").json()
        ada.bench = view["bench"]
        volts = float(view["sections"][0]["text"].split("Set ")[1].split("\u00a0")[0])
        for command in ({"kind": "pause"}, {"kind": "reset"}, {"set": {"reference.amplitude_v": volts}}):
            assert ada.ask("POST", f"/api/v1/benches/{ada.bench}/commands", json=command).is_success
        before = step(ada, 120)  # two windows of 50 ticks and a part of the third
        assert before["held_share"] == 0.5
        advance(live, seconds=0.7)  # a checkpoint is written

    with second as live:
        ada = Somebody(live, ada.secret, ada.bench)
        assert ada.me()["bench"] == ada.bench  # it has come back
        assert ada.ask("GET", sheet).json()["sections"][0]["step"] == before
        assert step(ada, 30)["held_share"] == 0.75  # the third window began before the crash
        assert step(ada, 49)["earned"] == 0.0 and step(ada, 1)["earned"] == 1.0
        view = ada.ask("GET", sheet).json()
        assert view["earned"] == 1.0 and view["sections"][1]["state"] == "open"
