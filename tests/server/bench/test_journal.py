"""A journal tells all of a bench: after any travels, its headless run has the bits of the bench."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.board.commands import parse_command
from core.board.stored import Stored, revived, stored
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build, run
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.build import Builder, rebuilt
from server.bench.commands import parse
from server.bench.description import document_of, experiment_of
from server.bench.status import Origin
from server.bench.travel import Past, _be_at_cue, forked, forward, repeat, reset, show
from server.metrics import Metrics
from server.settings import Settings
from server.store.experiment import Experiment
from tests.core.own.texts import PI

BUILDER = Builder(Settings(history_ticks=5000), Metrics(), lambda: 0.0)
COMMANDS: list[dict[str, Any]] = [
    {"fault": "added_mass", "severity": 0.05},
    {"fault": "damping", "severity": 0.3, "at_sample": 900},
    {"fault": "sensor_hum", "severity": 0.2, "when": "plant.displacement > 0.05"},
    {"heal": "all"},
    {"set": {"reference.amplitude_v": 4.0}},
    {"set": {"sensor.noise_um": 0.02}},
    {"switch": "pid"},
    {"switch": "mrac"},
    {"switch": "pi"},
    {"set": {"controllers.pi.integral_v_um_ms": -3.0}},
    {"set": {"guard.travel_um": 1e-3}},
    {"reset_trip": True},
    {"kind": "undo"},
    {"kind": "redo"},
]
UNDO, REDO = COMMANDS.index({"kind": "undo"}), COMMANDS.index({"kind": "redo"})
LAW = "proportional = p.proportional_v_um * e"
TEXTS = [PI, PI.replace(LAW, "proportional = 0.5 * p.proportional_v_um * e"), f"{PI}\n# a note\n"]
"""Versions of a unit of the bench itself: each changes its bits, or its text alone."""


class Traveller:
    """A user who does everything that takes a bench to another moment, one act after the other."""

    def __init__(self, name: str = "first-look") -> None:
        values = {"samples": 1_000_000, "events": [], "units": {"pi": {"source": PI}}}
        scenario = with_values(get(name), values)
        self.bench = BUILDER.around(scenario, build(scenario), None)
        self.bench.begin(True)
        self.kept: list[str] = []

    def run(self, ticks: int) -> None:
        end = self.bench.board.tick + ticks
        while self.bench.board.trip is None and self.bench.board.tick < end:
            self.bench.advance(end - self.bench.board.tick)

    def command(self, number: int) -> None:
        document = COMMANDS[number % len(COMMANDS)]
        command = parse(document) if "kind" in document else parse_command(document)
        try:
            self.bench.execute(command, "test")
        except InputError:  # such as healing a healthy device
            return

    def snapshot(self, _: int) -> None:
        self.kept = [*self.kept[-3:], self.bench.snapshots.take("", "test", 10**6).id]

    def restore(self, number: int) -> None:
        if self.kept:
            self.bench.snapshots.restore(self.kept[number % len(self.kept)], "test")

    def begin_again(self, number: int) -> None:
        scenario = with_values(self.bench.scenario, {"seed": number})
        reset(self.bench, scenario, build(scenario), "test")

    def write_unit(self, number: int) -> None:
        """Give the bench another version of its own unit, as the editor of the page does."""
        values = {"units.pi.source": TEXTS[number % len(TEXTS)], "seed": self.bench.board.spec.seed}
        scenario = with_values(self.bench.scenario, values)
        reset(self.bench, scenario, build(scenario), "test")

    def fork(self, _: int) -> None:
        self._go_on_with(forked(self.bench, None, BUILDER))

    def fork_at(self, number: int) -> None:
        track = self.bench.track
        assert track is not None
        first = track.first_tick
        tick = first + number % (self.bench.board.tick - first + 1)
        past = Past.take(self.bench, tick, 100, is_before=number % 2 == 0)
        journal = past.journal(lambda _: None)
        board = journal.board()
        twin = BUILDER.around(journal.scenario, board, None)
        assert twin.board.digest() == self.digest_at(tick), "the past is another"
        twin.events.go_on(self.bench.events.after(0)[1])
        twin.taken_over = twin.events.last
        twin.origin = Origin(bench="", tick=tick, window_ticks=100)
        show(twin, journal, "test", is_before=number % 2 == 0, board=board)
        other = first + number // 2 % (tick - first + 1)  # it seeks another moment at once
        if twin.is_past:
            show(twin, Past.take(self.bench, other, 100).journal(lambda _: None), "test")
        self._go_on_with(twin)

    def reopen(self, _: int) -> None:
        kept = Experiment.model_validate_json(experiment_of(self.bench).model_dump_json())
        scenario, board = rebuilt(kept, 10**7)
        twin = BUILDER.around(scenario, board, kept.time_scale)
        assert repeat(twin, kept), "its digest differs"
        self._go_on_with(twin)

    def crash(self, _: int) -> None:
        board = stored(self.bench.board)  # type: ignore[arg-type]
        again = revived(Stored(json.loads(json.dumps(board.document, default=str)), board.arrays))
        self._go_on_with(BUILDER.around(self.bench.scenario, again, None))

    def cue(self, number: int) -> None:
        scenario = with_values(self.bench.scenario, {"events": [{"at_sample": number // 2, **COMMANDS[0]}]})
        fresh = BUILDER.around(scenario, build(scenario), None)
        forward(fresh, number)
        _be_at_cue(self.bench, fresh, True, "test", "a cue")

    def _go_on_with(self, bench: LiveBench) -> None:
        assert bench.board.digest() == self.bench.board.digest() or bench.origin is not None
        bench.begin(True)
        self.bench, self.kept = bench, []

    def digest_at(self, tick: int) -> str:
        """Return the digest of the headless run of the journal up to a tick."""
        document = document_of(self.bench)
        events = [event for event in document["events"] if event.get("at_sample", 0) < tick]
        return (
            run(Scenario.load({**document, "events": events, "samples": max(tick, 1)})).digest if tick else self.fresh()
        )

    def fresh(self) -> str:
        return build(self.bench.scenario).digest()

    def is_true(self) -> bool:
        """Whether the headless run of the journal has the bits of the bench, now and at earlier ticks."""
        track, now = self.bench.track, self.bench.board.tick
        assert track is not None
        for tick in sorted({track.first_tick + part * (now - track.first_tick) // 4 for part in range(5)}):
            past = Past.take(self.bench, tick, 0).passage.board()
            assert past.digest() == self.digest_at(tick), f"the past at tick {tick} is another"
        units = self.bench.scenario.document["units"]
        assert units == self.bench.board.base["units"], "a reset begins with another version of its unit"
        return run(Scenario.load(document_of(self.bench))).digest == self.bench.board.digest()


ACTS: dict[str, Callable[[Traveller, int], None]] = {
    name: getattr(Traveller, name)
    for name in (
        *("run", "command", "snapshot", "restore", "begin_again", "write_unit", "fork"),
        *("fork_at", "reopen", "crash", "cue"),
    )
}
Acts = st.lists(st.tuples(st.sampled_from([*ACTS, "run", "command", "command"]), st.integers(1, 700)), max_size=14)


def travels(acts: list[tuple[str, int]], name: str = "first-look") -> None:
    traveller = Traveller(name)
    for name, number in acts:
        ACTS[name](traveller, number)
    traveller.run(50)
    assert traveller.is_true()


@settings(max_examples=12, derandomize=True, deadline=None, database=None)
@given(Acts)
def test_any_travels_equal_one_headless_run(acts: list[tuple[str, int]]) -> None:
    travels(acts)


@pytest.mark.long
@settings(max_examples=300, deadline=None, database=None)
@given(Acts)
def test_many_travels_equal_one_headless_run(acts: list[tuple[str, int]]) -> None:
    travels(acts)


@pytest.mark.parametrize("name", ["first-look", "ch3-indirect-mrac-b30"])
@pytest.mark.parametrize("act", [*sorted(ACTS.keys() - {"run", "command"})])
def test_each_travel_under_a_fault_a_waiting_command_and_an_undo(act: str, name: str) -> None:
    before = [("run", 300), ("snapshot", 1), ("command", 0), ("command", 1), ("command", 6), ("run", 200)]
    after = [("run", 250), ("command", 4), (act, 111), ("command", UNDO)]
    travels([*before, ("command", UNDO), (act, 333), *after], name)


def test_a_waiting_command_that_was_undone_and_redone_is_in_the_journal() -> None:
    travels([("run", 300), ("command", 1), ("command", UNDO), ("run", 700), ("run", 400)])
    travels([("run", 300), ("command", 1), ("command", UNDO), ("command", REDO), ("run", 700), ("run", 400)])


def test_a_bench_goes_back_and_forth_between_versions_of_its_own_unit() -> None:
    drives = COMMANDS.index({"switch": "pi"})
    first, second = [("command", drives), ("run", 300), ("snapshot", 1)], [("write_unit", 1), ("command", drives)]
    for way in (("command", UNDO), ("restore", 0), ("fork_at", 123), ("reopen", 1), ("crash", 1), ("write_unit", 2)):
        travels([*first, *second, ("run", 300), way, ("run", 200), ("command", UNDO)])
