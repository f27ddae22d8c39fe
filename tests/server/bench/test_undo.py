"""Undo and redo on a live bench: at the tick of now, and back in time after a reset."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.board.commands import parse_command
from core.errors import InputError
from scenarios.run import run
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.commands import parse
from server.bench.description import document_of
from server.bench.travel import reset
from server.bench.undo import AT_ONCE_S, MOST_JOURNALS
from tests.server.bench.test_session import advance, kinds, session


class Clock:
    """A clock that the test moves."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


def bench_at(tick: int, clock: Clock | None = None) -> LiveBench:
    bench = session("first-look", samples=100_000)
    if clock is not None:
        bench.clock = clock
    advance(bench, tick)
    return bench


def do(bench: LiveBench, document: dict[str, Any]) -> Any:
    return bench.execute(parse(document), "test")


def shown(bench: LiveBench) -> tuple[str | None, str | None]:
    status = bench.status
    return status.undo and status.undo.text, status.redo and status.redo.text


def test_a_fault_is_taken_back_and_injected_again_and_the_log_says_so() -> None:
    bench = bench_at(1000)
    do(bench, {"fault": "added_mass", "severity": 0.05})
    assert shown(bench) == ("inject added_mass +0.05", None)
    advance(bench, 2000)
    assert do(bench, {"kind": "undo"}).text == "undone: inject added_mass +0.05"
    assert not bench.board.faults and bench.board.tick == 2000
    assert shown(bench) == (None, "inject added_mass +0.05")
    advance(bench, 3000)
    do(bench, {"kind": "redo"})
    assert bench.board.faults["added_mass"].start_tick == 3000  # type: ignore[attr-defined]
    done = [kind for kind in kinds(bench) if kind in ("inject", "heal", "undone", "redone")]
    assert done == ["inject", "heal", "undone", "inject", "redone"]


def test_what_was_done_and_undone_runs_headless_to_the_same_bits() -> None:
    bench = bench_at(500)
    for document in (
        {"fault": "added_mass", "severity": 0.05},
        {"switch": "pid"},
        {"set": {"reference.kind": "chirp"}},
    ):
        do(bench, document)
        advance(bench, bench.board.tick + 300)
    for kind in ("undo", "undo", "redo", "undo", "undo"):
        do(bench, {"kind": kind})
        advance(bench, bench.board.tick + 300)
    assert bench.board.spec.reference == session("first-look").board.spec.reference and not bench.board.faults
    assert run(Scenario.load(document_of(bench))).digest == bench.board.digest()


def test_heal_all_gives_every_fault_back_with_its_profile() -> None:
    bench = bench_at(100)
    do(bench, {"fault": "added_mass", "severity": 0.05, "profile": {"kind": "ramp", "duration_ms": 2.0}})
    do(bench, {"fault": "sensor_hum", "severity": 0.1, "parameters": {"frequency_hz": 60.0}})
    acted = {name: params.model_dump(exclude={"start_tick"}) for name, params in bench.board.faults.items()}
    do(bench, {"heal": "all"})
    do(bench, {"kind": "undo"})
    now = {name: params.model_dump(exclude={"start_tick"}) for name, params in bench.board.faults.items()}
    assert now == acted


def test_a_command_that_waits_waits_no_more_and_one_that_took_effect_is_refused() -> None:
    bench = bench_at(100)
    do(bench, {"fault": "added_mass", "severity": 0.05, "at_sample": 400})
    do(bench, {"kind": "undo"})
    advance(bench, 500)
    assert not bench.board.faults and not len(bench.board.pending)
    do(bench, {"fault": "added_mass", "severity": 0.05, "at_sample": 600})
    advance(bench, 700)
    with pytest.raises(InputError, match=r"can no more be undone: it waits no more"):
        do(bench, {"kind": "undo"})
    with pytest.raises(InputError, match="nothing to undo"):
        do(bench, {"kind": "undo"})


def test_of_two_commands_that_wait_the_newest_is_taken_back_first() -> None:
    bench = bench_at(100)
    for at, fault in ((600, "added_mass"), (400, "damping")):
        do(bench, {"fault": fault, "severity": 0.05, "at_sample": at})
    do(bench, {"kind": "undo"})
    assert [entry.command.fault for entry in bench.board.pending] == ["added_mass"]  # type: ignore[union-attr]
    do(bench, {"kind": "redo"})
    advance(bench, 500)
    assert set(bench.board.faults) == {"damping"} and len(bench.board.pending) == 1


def test_a_reset_is_taken_back_with_what_was_seen_before_it() -> None:
    bench = bench_at(3000)
    do(bench, {"fault": "added_mass", "severity": 0.05})
    advance(bench, 5000)
    seen, digest = bench.history.read([0, 1, 2], 1000, 5000), bench.board.digest()
    fresh = session("first-look", samples=100_000).board
    reset(bench, bench.scenario, fresh, "test")  # type: ignore[arg-type]
    advance(bench, 6000)
    do(bench, {"kind": "undo"})
    assert bench.board.tick == 5000 and bench.board.digest() == digest and "added_mass" in bench.board.faults
    np.testing.assert_array_equal(bench.history.read([0, 1, 2], 1000, 5000), seen)
    do(bench, {"kind": "redo"})
    assert bench.board.tick == 6000 and not bench.board.faults
    do(bench, {"kind": "undo"})
    do(bench, {"kind": "undo"})
    assert bench.board.tick == 5000 and not bench.board.faults


def test_the_history_after_a_jump_holds_nothing_of_another_branch() -> None:
    """A snapshot before a reset and a run of another fault past its tick; then snapshots of two branches."""
    bench = bench_at(2000)
    kept, before = bench.snapshots.take("a", "test", 9), bench.history.read([0, 1, 2], 0, 2000)
    bench.snapshots.restore(kept.id, "test")
    np.testing.assert_array_equal(bench.history.read([0, 1, 2], 0, 2000), before)
    reset(bench, bench.scenario, session("first-look", samples=100_000).board, "test")  # type: ignore[arg-type]
    do(bench, {"fault": "added_mass", "severity": 0.5})
    advance(bench, 3000)
    bench.snapshots.restore(kept.id, "test")
    assert bench.board.tick == 2000 and bench.history.first_tick == bench.history.end_tick
    advance(bench, 2500)
    other, seen = bench.snapshots.take("b", "test", 9), bench.history.read([0, 1, 2], 2000, 2500)
    bench.snapshots.restore(kept.id, "test")
    advance(bench, 2600)
    bench.snapshots.restore(other.id, "test")
    assert bench.board.tick == 2500 and bench.history.first_tick == bench.history.end_tick
    advance(bench, 2700)
    bench.snapshots.restore(other.id, "test")
    assert bench.history.end_tick == 2500 and seen.shape == (3, 500)


def test_a_trip_is_gone_back_to_when_its_reset_is_undone() -> None:
    bench = bench_at(100)
    do(bench, {"set": {"guard.travel_um": 1e-4}})
    advance(bench, 4000)
    assert bench.board.trip is not None
    trip = bench.board.trip
    do(bench, {"reset_trip": True})
    assert bench.board.trip is None
    do(bench, {"kind": "undo"})
    assert bench.board.trip == trip and not bench.is_running


def test_a_slider_that_is_pulled_is_one_change() -> None:
    clock = Clock()
    bench = bench_at(100, clock)
    was = bench.board.spec.reference
    for k in range(5):
        clock.now += 0.5 * AT_ONCE_S
        do(bench, {"set": {"reference.amplitude_v": 5.0 + k}})
    clock.now += 2 * AT_ONCE_S
    do(bench, {"set": {"reference.amplitude_v": 1.0}})
    do(bench, {"kind": "undo"})
    assert bench.board.spec.reference.params.amplitude_v == 9.0  # type: ignore[attr-defined]
    do(bench, {"kind": "undo"})
    assert bench.board.spec.reference == was and shown(bench)[0] is None


def test_a_new_change_forgets_what_was_undone_and_moments_are_few() -> None:
    bench = bench_at(100)
    do(bench, {"switch": "pid"})
    do(bench, {"kind": "undo"})
    do(bench, {"fault": "added_mass", "severity": 0.05})
    with pytest.raises(InputError, match="nothing to redo"):
        do(bench, {"kind": "redo"})
    for _ in range(MOST_JOURNALS + 2):
        reset(bench, bench.scenario, session("first-look", samples=100_000).board, "test")  # type: ignore[arg-type]
    for _ in range(MOST_JOURNALS):
        do(bench, {"kind": "undo"})
    with pytest.raises(InputError, match="nothing to undo"):
        do(bench, {"kind": "undo"})


def test_a_refused_command_leaves_nothing_to_undo() -> None:
    bench = bench_at(10)
    with pytest.raises(InputError):
        bench.execute(parse_command({"set": {"guard.travel_um": -1.0}}), "test")
    assert shown(bench) == (None, None)
