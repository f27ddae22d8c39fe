"""A live bench without a server around it: end, trip, reset, restore, fork, saving."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, cast

import numpy as np
import pytest

from core.board.commands import parse_command
from core.board.condition import parse_condition
from core.board.history import History
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build, run
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.build import Builder
from server.bench.commands import parse
from server.bench.description import document_of
from server.bench.events import Event
from server.bench.travel import forked, reset
from server.metrics import Metrics
from server.settings import Settings

MAKER = Builder(Settings(), Metrics(), lambda: 0.0)


def session(name: str = "ch5-seven-step", scale: float | None = None, **values: Any) -> LiveBench:
    scenario = with_values(get(name), values)
    found = LiveBench(scenario, build(scenario), scale, 20_000, Metrics(), lambda: 0.0)
    found.begin(True)
    return found


def advance(bench: LiveBench, tick: int) -> None:
    """Run up to a tick as the engine does."""
    while bench.is_running and bench.board.tick < tick:
        end = bench.time.target(0.0)
        bench.time.slice(tick if end is None else min(tick, end))


def step(bench: LiveBench, kind: str = "step", **fields: Any) -> Future[Event]:
    """Ask for a step; it is not taken yet."""
    asked = bench.execute(parse({"kind": kind, **fields}), "test")
    assert isinstance(asked, Future)
    return asked


def kinds(bench: LiveBench) -> list[str]:
    return [event.kind for event in bench.events.after(0)[1]]


def test_it_pauses_once_at_the_end_of_its_scenario() -> None:
    bench = session(samples=1000)
    assert bench.time.target(1e9) == 1000
    advance(bench, 5000)
    assert bench.board.tick == 1000 and not bench.is_running
    assert kinds(bench)[-1] == "finished"
    bench.execute(parse({"kind": "start"}), "test")
    advance(bench, 1500)
    assert bench.board.tick == 1500 and bench.is_running
    assert kinds(bench).count("finished") == 1


def test_a_trip_pauses_it_and_only_a_reset_leads_out() -> None:
    bench = session("ch3-mrac-spring-x2", **{"controllers.mrac.adaptation_gain": 30.0})
    if bench.scenario.samples is not None:
        bench.time.ends_at = None
    bench.execute(parse({"set": {"guard.travel_um": 0.01}}), "test")
    advance(bench, 20_000)
    assert bench.status.state == "tripped" and not bench.is_running
    assert bench.status.trip is not None and bench.status.trip.signal == "plant.displacement"
    with pytest.raises(InputError, match="tripped"):
        bench.execute(parse({"kind": "start"}), "test")
    tick = bench.board.tick
    bench.execute(parse({"set": {"guard.travel_um": 25.0}}), "test")
    bench.execute(parse({"reset_trip": True}), "test")
    assert bench.status.state == "paused" and bench.board.tick == tick
    bench.execute(parse({"kind": "start"}), "test")
    advance(bench, tick + 10)
    assert bench.status.state == "running" or bench.board.tick == tick + 10


def test_a_refused_command_changes_nothing() -> None:
    bench = session()
    advance(bench, 100)
    before = bench.board.save(), bench.events.last
    for refused in (
        {"heal": ["damping"]},
        {"switch": "nobody"},
        {"set": {"sensor.noise_um": -1}},
        {"set": {"sensor.noise_um": 0.1, "sample_rate_khz": 10}},
    ):
        with pytest.raises(InputError):
            bench.execute(parse_command(refused), "test")
    assert (bench.board.save(), bench.events.last) == before


def test_steps_are_exact() -> None:
    bench = session()
    asked = step(bench, ticks=7), step(bench, "step_period")
    while bench.is_running:
        bench.time.slice(bench.time.target(1e9))
    assert bench.board.tick == 7 + 25  # 2 kHz at 50 kHz
    assert bench.history.end_tick == 32 and bench.status.state == "paused"
    assert [(event.result(0).tick, event.result(0).text) for event in asked] == [
        (0, "stepped 7 ticks"),
        (7, "stepped 25 ticks"),
    ]


def test_a_long_step_is_taken_in_slices_with_commands_between() -> None:
    """A pause ends it, and the log shows its length; the bits equal the bits of a running bench."""
    bench = session(samples=9000)
    asked, behind = step(bench, ticks=5000), step(bench, ticks=3)
    bench.time.slice(bench.time.target(0.0))
    assert bench.board.tick == bench.board.chunk and bench.is_running and not bench.is_started
    bench.execute(parse_command({"fault": "damping", "severity": 0.3}), "test")
    bench.time.slice(bench.time.target(0.0))
    bench.time.finish_round(bench.time.target(0.0), 0.0)
    assert (bench.time.pacer.overruns, bench.status.state, bench.status.achieved_scale) == (0, "running", 0.0)
    assert not asked.done()
    bench.execute(parse({"kind": "pause"}), "test")
    assert asked.result(0).text == "stepped 4608 of 5000 ticks" and asked.result(0).tick == 0
    assert behind.result(0).text == "stepped 0 of 3 ticks"
    assert kinds(bench)[-3:] == ["step", "step", "pause"]
    assert not bench.is_running and bench.status.state == "paused" and bench.board.tick == 512 + 4096
    saved = Scenario.load(document_of(bench))
    assert run(saved).digest == bench.board.digest()


@pytest.mark.parametrize("how", ["reset", "restore", "close", "fail", "start", "trip"])
def test_who_waits_for_a_step_hears_how_it_ended(how: str) -> None:
    bench = session()
    kept = bench.snapshots.take("here", "test", 8)
    asked = step(bench, ticks=5000)
    bench.time.slice(None)
    acts: dict[str, Callable[[], Any]] = {
        "reset": lambda: reset(bench, bench.scenario, build(bench.scenario), "test"),
        "restore": lambda: bench.snapshots.restore(kept.id, "test"),
        "close": bench.close,
        "fail": lambda: bench.fail(RuntimeError("broken on purpose")),
        "start": lambda: bench.execute(parse({"kind": "start"}), "test"),
        "trip": lambda: bench.execute(parse({"set": {"guard.travel_um": 1e-3}}), "test"),
    }
    acts[how]()
    while how == "trip" and bench.is_running:
        bench.time.slice(None)
    assert asked.result(0).text == f"stepped {asked.result(0).text.split()[1]} of 5000 ticks"
    assert bench.is_running == (how == "start")


def test_a_step_that_is_refused_does_not_pause() -> None:
    bench = session(**{"reference": {"kind": "constant", "amplitude_v": 1.0}})
    with pytest.raises(InputError, match="no period"):
        step(bench, "step_period")
    assert bench.is_started
    with pytest.raises(InputError, match="wait for their turn"):
        for _ in range(200):
            step(bench, ticks=3)


@pytest.mark.parametrize("steps", [False, True])
def test_a_slice_of_a_slow_bench_is_short(steps: bool) -> None:
    """At 2^-17 s a tick 2 ms are 262 ticks; after a wait of 128 times that the next has a fourth, then all."""
    now = [0.0]
    scenario = get("ch5-seven-step")
    bench = LiveBench(scenario, build(scenario), None, 20_000, Metrics(), lambda: now[0])
    board = bench.board
    ran: list[int] = []

    def slow(history: History, n: int) -> Any:
        ticks = type(board).advance_into(board, history, n)
        ran.append(ticks.count)
        now[0] += ticks.count * 2.0 ** (-17 if len(ran) != 3 else -10)
        return ticks

    board.advance_into = slow  # type: ignore[method-assign]
    bench.begin(not steps)
    if steps:
        step(bench, ticks=1600)
    for _ in range(5):
        bench.time.slice(None)
    assert ran == [512, 262, 262, 65, 262]


class TakesAll:
    """A recorder that keeps what it gets."""

    id, is_open, reason = "one", True, "stopped"

    def __init__(self) -> None:
        self.began: list[int] = []
        self.samples: dict[int, np.ndarray] = {}

    def begin(self, past: Any, _ticks: int | None) -> None:
        self.began.append(past.end)

    def append(self, first: int, samples: np.ndarray) -> None:
        self.samples |= {first + i: samples[:, i] for i in range(samples.shape[1])}

    def note(self, *_: Any) -> None: ...

    def stop(self, _reason: str) -> None: ...


def test_a_recording_begins_where_its_condition_holds_before_numbers_are_rounded() -> None:
    """In single precision this number is below the limit; later ticks are recorded as the history has them."""
    bench, recorder = session(), TakesAll()
    board = build(bench.scenario)
    values = board.advance(400).outputs[:, board.signals.index("plant.displacement")]
    tops = np.flatnonzero(values == np.maximum.accumulate(values))
    tick = int(next(at for at in tops[5:] if np.float32(values[at]) < values[at]))
    limit = np.nextafter(values[tick], -np.inf)
    assert not np.float32(values[tick]) > limit
    condition = parse_condition(f"plant.displacement > {float(limit)!r}", bench.column_of)
    bench.recordings.begin(cast(Any, recorder), "edge", "test", 0, None, condition)
    while bench.board.tick < 1000:
        bench.advance(300)
    found = [event.text for event in bench.events.after(0)[1] if event.kind == "recording_started"]
    assert found == [f"a recording began: its condition held at tick {tick}"]
    names = list(range(len(bench.signals)))
    for at in range(bench.board.tick - 300, bench.board.tick):
        np.testing.assert_array_equal(recorder.samples[at], bench.history.read(names, at, at + 1)[:, 0])


def test_going_back_and_on_gives_the_same_bits_and_keeps_the_past() -> None:
    bench = session()
    advance(bench, 1500)
    snapshot = bench.snapshots.take("here", "test", 8)
    advance(bench, 4000)
    digest, past = bench.board.digest(), bench.history.read([0], 0, 1500)
    bench.snapshots.restore(snapshot.id, "test")
    assert bench.board.tick == 1500 and bench.history.end_tick == 1500
    np.testing.assert_array_equal(bench.history.read([0], 0, 1500), past)
    advance(bench, 4000)
    assert bench.board.digest() == digest
    # The pyramid over the seam is whole: minima and maxima are the minima and maxima of the samples.
    samples = bench.history.read([0], 1400, 1656)[0]
    columns = bench.history.columns([0], 1400, 1656, 4)[0]
    np.testing.assert_array_equal(columns[0], samples.reshape(4, 64).min(1))
    np.testing.assert_array_equal(columns[1], samples.reshape(4, 64).max(1))


def test_a_fork_goes_its_own_way_from_the_same_moment() -> None:
    bench = session()
    advance(bench, 1000)
    twin = forked(bench, None, MAKER)
    twin.begin(True)
    np.testing.assert_array_equal(twin.history.read([3], 0, 1000), bench.history.read([3], 0, 1000))
    twin.execute(parse({"fault": "added_mass", "severity": 0.1}), "test")
    advance(bench, 1800)
    advance(twin, 1800)
    assert bench.board.digest() == run(with_values(get("ch5-seven-step"), {"samples": 1800})).digest
    assert twin.board.digest() != bench.board.digest()


def test_a_reset_begins_again_with_other_values() -> None:
    bench = session()
    advance(bench, 700)
    scenario = with_values(bench.scenario, {"sensor.noise_um": 0.2})
    reset(bench, scenario, build(scenario), "test")
    assert bench.board.tick == 0 and bench.history.end_tick == 0
    advance(bench, 500)
    assert bench.board.digest() == run(with_values(scenario, {"samples": 500})).digest
    other = with_values(scenario, {"diagnosers": {}})
    with pytest.raises(InputError, match="other signals"):
        reset(bench, other, build(other), "test")


def test_what_happened_is_saved_as_a_scenario_with_the_same_bits() -> None:
    bench = session()
    advance(bench, 333)
    bench.execute(parse({"switch": "mrac"}), "test")
    advance(bench, 777)
    bench.execute(parse({"fault": "damping", "severity": 0.3}), "test")
    bench.execute(parse({"set": {"sensor.noise_um": 0.1}}), "test")
    advance(bench, 2501)
    saved = Scenario.load(Scenario.load(document_of(bench)).toml())
    result = run(saved)
    assert result.board.tick == 2501
    assert result.digest == bench.board.digest()


def test_commands_that_wait_are_limited() -> None:
    bench = session()
    with pytest.raises(InputError, match="wait for their moment"):
        for _ in range(200):
            bench.execute(parse({"switch": "pid", "at_sample": 8000}), "test")


def test_status_says_what_was_chosen_for_a_fault() -> None:
    bench = session()
    bench.execute(parse({"fault": "sensor_hum", "severity": 0.2}), "test")
    chosen = {"beam": "outer", "position": 0.5}
    bench.execute(parse({"fault": "point_adhesion", "severity": 1.0, "parameters": chosen}), "test")
    bench.execute(parse({"fault": "added_mass", "severity": 0.1}), "test")
    acting = {fault.name: fault.parameters for fault in bench.status.faults}
    assert acting == {"sensor_hum": {"frequency_hz": 50.0}, "point_adhesion": chosen, "added_mass": {}}
