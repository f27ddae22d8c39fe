"""A live bench without a server around it: end, trip, reset, restore, fork, saving."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.board.commands import parse_command
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build, run
from scenarios.schema import Scenario
from server.bench.commands import parse
from server.bench.session import Session
from server.metrics import Metrics


def session(name: str = "ch5-seven-step", scale: float | None = None, **values: Any) -> Session:
    scenario = with_values(get(name), values)
    found = Session(scenario, build(scenario), scale, 20_000, Metrics(), lambda: 0.0)
    found.begin(True)
    return found


def advance(bench: Session, tick: int) -> None:
    """Run up to a tick as the engine does."""
    while bench.is_running and bench.board.tick < tick:
        end = bench.target(0.0)
        bench.slice(tick if end is None else min(tick, end))


def kinds(bench: Session) -> list[str]:
    return [event.kind for event in bench.events.after(0)[1]]


def test_it_pauses_once_at_the_end_of_its_scenario() -> None:
    bench = session(samples=1000)
    assert bench.target(1e9) == 1000
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
        bench._ends_at = None
    bench.execute(parse({"kind": "set", "values": {"guard.travel_um": 0.01}}), "test")
    advance(bench, 20_000)
    assert bench.status.state == "tripped" and not bench.is_running
    assert bench.status.trip is not None and bench.status.trip.signal == "plant.displacement"
    with pytest.raises(InputError, match="tripped"):
        bench.execute(parse({"kind": "start"}), "test")
    tick = bench.board.tick
    bench.execute(parse({"kind": "set", "values": {"guard.travel_um": 25.0}}), "test")
    bench.execute(parse({"kind": "reset_trip"}), "test")
    assert bench.status.state == "paused" and bench.board.tick == tick
    bench.execute(parse({"kind": "start"}), "test")
    advance(bench, tick + 10)
    assert bench.status.state == "running" or bench.board.tick == tick + 10


def test_a_refused_command_changes_nothing() -> None:
    bench = session()
    advance(bench, 100)
    before = bench.board.save(), bench.events.last
    for refused in (
        {"kind": "heal", "faults": ["damping"]},
        {"kind": "switch", "controller": "nobody"},
        {"kind": "set", "values": {"sensor.noise_um": -1}},
        {"kind": "set", "values": {"sensor.noise_um": 0.1, "sample_rate_khz": 10}},
    ):
        with pytest.raises(InputError):
            bench.execute(parse_command(refused), "test")
    assert (bench.board.save(), bench.events.last) == before


def test_steps_are_exact() -> None:
    bench = session()
    bench.execute(parse({"kind": "step", "ticks": 7}), "test")
    assert bench.board.tick == 7 and bench.status.state == "paused"
    bench.execute(parse({"kind": "step_period"}), "test")
    assert bench.board.tick == 7 + 25  # 2 kHz at 50 kHz
    assert bench.history.end_tick == 32


def test_a_reference_without_a_period_cannot_be_stepped_by_one() -> None:
    bench = session(**{"reference": {"kind": "constant", "amplitude_v": 1.0}})
    with pytest.raises(InputError, match="no period"):
        bench.execute(parse({"kind": "step_period"}), "test")


def test_going_back_and_on_gives_the_same_bits_and_keeps_the_past() -> None:
    bench = session()
    advance(bench, 1500)
    snapshot = bench.take_snapshot("here", "test", 8)
    advance(bench, 4000)
    digest, past = bench.board.digest(), bench.history.read([0], 0, 1500)
    bench.restore(snapshot.id, "test")
    assert bench.board.tick == 1500 and bench.history.end_tick == 1500
    np.testing.assert_array_equal(bench.history.read([0], 0, 1500), past)
    advance(bench, 4000)
    assert bench.board.digest() == digest
    # The pyramid over the seam is whole: minima and maxima are those of the samples.
    samples = bench.history.read([0], 1400, 1656)[0]
    columns = bench.history.columns([0], 1400, 1656, 4)[0]
    np.testing.assert_array_equal(columns[0], samples.reshape(4, 64).min(1))
    np.testing.assert_array_equal(columns[1], samples.reshape(4, 64).max(1))


def test_a_fork_goes_its_own_way_from_the_same_moment() -> None:
    bench = session()
    advance(bench, 1000)
    twin = bench.fork(None)
    twin.begin(True)
    np.testing.assert_array_equal(twin.history.read([3], 0, 1000), bench.history.read([3], 0, 1000))
    twin.execute(parse({"kind": "inject", "fault": "added_mass", "severity": 0.1}), "test")
    advance(bench, 1800)
    advance(twin, 1800)
    assert bench.board.digest() == run(with_values(get("ch5-seven-step"), {"samples": 1800})).digest
    assert twin.board.digest() != bench.board.digest()


def test_a_reset_begins_again_with_other_values() -> None:
    bench = session()
    advance(bench, 700)
    scenario = with_values(bench.scenario, {"sensor.noise_um": 0.2})
    bench.reset(scenario, build(scenario), "test")
    assert bench.board.tick == 0 and bench.history.end_tick == 0
    advance(bench, 500)
    assert bench.board.digest() == run(with_values(scenario, {"samples": 500})).digest
    other = with_values(scenario, {"diagnosers": {}})
    with pytest.raises(InputError, match="other signals"):
        bench.reset(other, build(other), "test")


def test_what_happened_is_saved_as_a_scenario_with_the_same_bits() -> None:
    bench = session()
    advance(bench, 333)
    bench.execute(parse({"kind": "switch", "controller": "mrac"}), "test")
    advance(bench, 777)
    bench.execute(parse({"kind": "inject", "fault": "damping", "severity": 0.3}), "test")
    bench.execute(parse({"kind": "set", "values": {"sensor.noise_um": 0.1}}), "test")
    advance(bench, 2501)
    saved = Scenario.load(Scenario.load(bench.document()).toml())
    result = run(saved)
    assert result.board.tick == 2501
    assert result.digest == bench.board.digest()


def test_commands_that_wait_are_limited() -> None:
    bench = session()
    with pytest.raises(InputError, match="wait for their moment"):
        for _ in range(200):
            bench.execute(parse({"kind": "switch", "controller": "pid", "at_sample": 8000}), "test")


def test_status_says_what_was_chosen_for_a_fault() -> None:
    bench = session()
    bench.execute(parse({"kind": "inject", "fault": "sensor_hum", "severity": 0.2}), "test")
    chosen = {"beam": "outer", "position": 0.5}
    bench.execute(parse({"kind": "inject", "fault": "point_adhesion", "severity": 1.0, "parameters": chosen}), "test")
    bench.execute(parse({"kind": "inject", "fault": "added_mass", "severity": 0.1}), "test")
    acting = {fault.name: fault.parameters for fault in bench.status.faults}
    assert acting == {"sensor_hum": {"frequency_hz": 50.0}, "point_adhesion": chosen, "added_mass": {}}
