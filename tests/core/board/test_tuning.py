"""Sets of parameters: a set taken from a bench gives its values on another bench."""

from __future__ import annotations

from typing import Any

import pytest

from core.board.board import Board
from core.board.commands import parse_command
from core.board.tuning import difference, tuned
from scenarios.library import get
from scenarios.run import build

CHANGES: list[tuple[str, dict[str, Any]]] = [
    ("first-look", {"reference.kind": "chirp"}),
    ("first-look", {"environment.temperature_k": 320.0, "controllers.pid.proportional_v_um": 0.3}),
    ("first-look", {"diagnosers.kalman.sensor_noise_um": 0.2, "diagnosers.kalman.probability_floor": 0.01}),
    ("gyro-first-look", {"controllers.drive_loop.amplitude_um": 2.0, "rate.kind": "sine"}),
    ("gyro-first-look", {"guard.rail_ms": 20.0}),
]


def setting(board: Board, values: dict[str, Any]) -> None:
    if values:
        board.apply(parse_command({"set": values}))


@pytest.mark.parametrize(("scenario", "values"), CHANGES)
def test_a_set_put_on_a_bench_gives_its_values_there_and_back(scenario: str, values: dict[str, Any]) -> None:
    one, other = build(get(scenario)), build(get(scenario))
    before = tuned(one.spec)
    setting(other, values)
    after = tuned(other.spec)
    assert after != before
    setting(one, difference(one.spec, after))
    assert tuned(one.spec) == after and difference(one.spec, after) == {}
    assert [i.params for i in one.wiring.instances] == [i.params for i in other.wiring.instances]
    setting(one, difference(one.spec, before))
    assert tuned(one.spec) == before


def test_only_what_differs_is_set_and_what_a_bench_does_not_have_is_left_out() -> None:
    bench = build(get("first-look"))
    wanted = {**tuned(bench.spec), "drive.limit_v": 12.0, "controllers.no_such.gain": 1.0}
    assert difference(bench.spec, wanted) == {"drive.limit_v": 12.0}


def test_what_cannot_change_while_a_bench_runs_is_in_no_set() -> None:
    values = tuned(build(get("first-look")).spec)
    assert "diagnosers.kalman.hypotheses" not in values and "device.id" not in values
    assert values["drive.limit_v"] == 30.0 and values["reference.kind"] == "sine"
