"""A block that stays in shadow to the end is left out, and no bit of the results depends on it."""

from __future__ import annotations

from typing import Any

import pytest

from core.board.ensemble import Ensemble
from core.board.idle import looking_on
from scenarios.edit import with_values
from scenarios.library import get, library
from scenarios.run import build, run
from scenarios.schema import Scenario

TICKS = 300
SWITCHED = {"controller.kind": "open_loop", "events": [{"at_sample": 100, "set": {"controller.kind": "mrac"}}]}
NESTED = {"events": [{"at_sample": 100, "switch": "pid"}, {"at_sample": 200, "set": {"sensor.kind": "single_beam"}}]}
AWAITED = {"events": [{"when": "vsc.voltage > 0.001", "fault": "added_mass", "severity": 0.2}]}


def cut(scenario: Scenario) -> Scenario:
    document = {key: value for key, value in scenario.document.items() if key != "duration_ms"}
    return Scenario.load({**document, "samples": min(TICKS, scenario.samples or TICKS)})


def live(scenario: Scenario) -> str:
    board = build(scenario)
    while board.tick < (scenario.samples or 0) and board.advance((scenario.samples or 0) - board.tick).count:
        continue
    return board.digest()


def check(scenario: Scenario) -> Any:
    """Return a run without blocks in shadow, compared with a run that has them."""
    alone, everything = run(scenario, taps=True), run(scenario, taps=True, everything=True)
    assert alone.digest == everything.digest == live(scenario), scenario.id
    assert alone.metrics == everything.metrics and alone.warnings == everything.warnings, scenario.id
    assert [one.model_dump() for one in alone.board.log] == [one.model_dump() for one in everything.board.log]
    assert [one.name for one in everything.kept] == everything.board.signals.names
    for name, values in alone.trace.items():
        assert values.tobytes() == everything.trace[name].tobytes(), (scenario.id, name)
    return alone


@pytest.mark.long
@pytest.mark.timeout(600)
def test_the_library() -> None:
    for scenario in library():
        if scenario.study is None:
            check(cut(scenario))


@pytest.mark.parametrize(
    ("values", "runs"),
    [
        ({}, {"open_loop", "ideal"}),
        (SWITCHED, {"open_loop", "mrac", "ideal"}),
        (NESTED, {"open_loop", "pid", "ideal", "single_beam", "through_wafer"}),
        (AWAITED, {"open_loop", "vsc", "ideal"}),
        ({"sensors": {"capacitive": {"always": True}}}, {"open_loop", "ideal", "capacitive"}),
    ],
    ids=["nothing", "a controller set", "a switch and a sensor", "a condition", "a sensor that always runs"],
)
def test_what_an_event_needs_runs(values: dict[str, Any], runs: set[str]) -> None:
    scenario = with_values(get("ch5-seven-step"), {"samples": TICKS, "events": [], "expect": [], **values})
    board = build(scenario)
    blocks = {*board.spec.controllers, *board.spec.sensors}
    assert blocks - looking_on(board) == runs
    alone = check(scenario)
    assert {signal.block for signal in alone.kept} & blocks == runs


def test_twins_leave_out_what_looks_on_as_well() -> None:
    scenario = get("ch1-shock")
    board = run(scenario).board
    assert isinstance(board, Ensemble)
    for one in (board, *board.twins.values()):
        left = {one.wiring.instances[row].key for row in one.wiring.left_out}
        assert "mrac" in left and one.spec.active not in left


ESTIMATES = {"kalman.weighted", "self_tuning.states", "self_tuning.weighted"}
ASKED = {"metrics": {"estimation": True}}
EXPECTED = {"expect": [{"metric": "estimation.kalman.rms_error_um", "max": 1.0}]}


def waits(condition: str) -> dict[str, Any]:
    return {"events": [{"when": condition, "fault": "added_mass", "severity": 0.2}]}


@pytest.mark.parametrize(
    ("values", "runs"),
    [
        ({}, set()),
        (ASKED, ESTIMATES),
        (EXPECTED, ESTIMATES),
        (waits("kalman.winner > 0.5"), set()),
        (waits("self_tuning.weighted.stiffness > 1.01"), {"self_tuning.states", "self_tuning.weighted"}),
        (waits("self_tuning.state_velocity.healthy > 1"), {"self_tuning.states"}),
    ],
    ids=["nothing", "figures", "an expectation", "a condition on a verdict", "on a weight", "on a state"],
)
def test_weighted_estimates_run_where_something_reads_them(values: dict[str, Any], runs: set[str]) -> None:
    banks = {"diagnosers.self_tuning": {"kind": "self_tuning"}}
    base = {"samples": TICKS, "sample_rate_khz": 20, "events": [], "expect": []}
    scenario = with_values(get("ch5-seven-step"), {**base, **banks, **values})
    board = build(scenario)
    assert ESTIMATES - looking_on(board) == runs
    alone = check(scenario)
    figures = {name.split(".")[1] for name in alone.metrics if name.startswith("estimation.")}
    assert figures == ({"kalman", "self_tuning"} if runs == ESTIMATES else set())
    assert (
        run(with_values(scenario, {"events": [], **ASKED})).digest == run(with_values(scenario, {"events": []})).digest
    )


def test_a_block_that_reads_a_weighted_estimate_lets_all_that_it_is_made_of_run() -> None:
    scenario = with_values(get("ch5-seven-step"), {"diagnosers.self_tuning": {"kind": "self_tuning"}})
    board = build(scenario)
    wiring = board.wiring
    wiring.ports(wiring.row("model"))[0] = wiring.index["self_tuning.weighted.stiffness"]
    assert ESTIMATES & looking_on(board) == {"kalman.weighted"}
