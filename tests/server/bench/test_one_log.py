"""A board notes in the log of its live bench: nothing twice, nothing lost, and nothing in the log of another."""

from __future__ import annotations

from typing import Any

import pytest

from core.board.board import Board
from core.board.ensemble import Ensemble
from core.errors import InputError
from scenarios.run import build
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.build import Builder
from server.bench.commands import parse
from server.bench.events import Event
from server.bench.travel import forked, reset
from server.metrics import Metrics
from server.settings import Settings
from tests.lab import document

EVENTS = [
    {"at_sample": 20, "fault": "stiffness", "severity": 0.2},
    {"at_sample": 30, "heal": ["damping"]},
    {"at_sample": 5000, "switch": "pid"},
]

MAKER = Builder(Settings(), Metrics(), lambda: 0.0)


def session(**more: Any) -> LiveBench:
    scenario = Scenario.load({**document(), "id": "told", "events": EVENTS, **more})
    found = LiveBench(scenario, build(scenario), None, 1000, Metrics(), lambda: 0.0)
    found.begin(True)
    return found


def told(bench: LiveBench, after: int = 0) -> list[tuple[int, str]]:
    """Return tick and kind of the events; the numbers have no gap."""
    lost, events = bench.events.after(after)
    assert not lost and [event.seq for event in events] == list(range(after + 1, bench.events.last + 1))
    return [(event.tick, event.kind) for event in events]


def do(bench: LiveBench, **command: Any) -> Event:
    event = bench.execute(parse(command), "test")
    assert isinstance(event, Event) and event == bench.events.after(event.seq - 1)[1][0]
    return event


BEGUN = [(0, "scheduled")] * 3 + [(0, "opened")]


def test_what_the_board_notes_is_in_the_order_it_happened() -> None:
    bench = session()
    bench.advance(50)
    event = do(bench, switch="mrac")
    assert (event.kind, event.text, event.command) == ("switch", "switch to mrac", {"switch": "mrac"})
    assert event.seq == bench.events.last == 7
    do(bench, fault="damping", severity=0.5, at_sample=80)
    do(bench, kind="pause")
    assert told(bench) == [*BEGUN, (20, "inject"), (30, "refused"), *[(50, "switch"), (50, "scheduled"), (50, "pause")]]
    with pytest.raises(InputError):
        do(bench, switch="mrac")
    assert bench.events.last == 9
    bench.advance(50)
    assert told(bench, 9) == [(80, "inject")]


def test_going_back_goes_on_with_the_log_and_forgets_what_was_undone() -> None:
    bench = session()
    bench.advance(25)
    kept = bench.snapshots.take("here", "test", 8)
    do(bench, switch="mrac")
    bench.advance(25)
    saved = len(bench.board.save()["events"])
    bench.snapshots.restore(kept.id, "test")
    assert told(bench) == [
        *BEGUN,
        *[(20, "inject"), (25, "snapshot_taken"), (25, "switch"), (30, "refused"), (25, "restored")],
    ]
    assert saved == 3  # a refused event is not saved
    assert bench.board.save()["events"] == [
        {"at_sample": 20, "fault": "stiffness", "severity": 0.2},
        {"at_sample": 30, "heal": ["damping"]},
        {"at_sample": 5000, "switch": "pid"},
    ]
    bench.advance(25)
    assert told(bench, 9) == [(30, "refused")]


def test_a_reset_says_so_before_what_the_new_board_waits_for() -> None:
    bench = session()
    bench.advance(25)
    reset(bench, bench.scenario, build(bench.scenario), "test")
    bench.advance(25)
    assert told(bench) == [*BEGUN, (20, "inject"), (0, "reset"), *BEGUN[:3], (20, "inject")]


def test_a_fork_and_a_copy_note_for_themselves() -> None:
    bench = session()
    bench.advance(25)
    before = bench.events.last
    twin = forked(bench, None, MAKER)
    twin.begin(True)
    copy = Board.restore(bench.board.checkpoint())
    copy.apply(parse({"switch": "mrac"}))
    do(twin, heal="all")
    assert bench.events.last == before and told(twin) == [(25, "forked"), (25, "opened"), (25, "heal")]
    assert [entry.kind for entry in copy.log] == ["switch"]
    assert [event["at_sample"] for event in twin.board.save()["events"]] == [20, 25, 30, 5000]
    assert [event["at_sample"] for event in bench.board.save()["events"]] == [20, 30, 5000]


def test_twins_do_what_the_board_does_and_tell_it_to_the_same_log() -> None:
    bench = session(twins={"weak": {"guard": {"travel_um": 1e-4}}, "calm": {"guard": {"travel_um": 20.0}}})
    assert isinstance(bench.board, Ensemble)
    bench.advance(25)
    do(bench, switch="mrac")
    bench.advance(5)
    # events of a twin in a slice come after the events of the board in it
    assert told(bench)[4:] == [(20, "inject"), (3, "twin_tripped"), (25, "switch")]
    calm = bench.board.twins["calm"]
    assert calm.spec.active == bench.board.spec.active == "mrac"
    assert [type(command).__name__ for _, command in calm.done] == ["Inject", "Switch"]
