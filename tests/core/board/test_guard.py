"""Drive, converter and guard: limits, rounding, trips and the way out of them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.converter import reach
from core.errors import InputError
from scenarios.run import build, run
from scenarios.schema import Scenario
from tests.lab import AXES_RICH, QUIET, RICH, do, document, inject, make, play

FAST = {"reference.frequency_hz": 2000.0}


def test_drive_clips_and_rounds():
    values = {**FAST, "drive.limit_v": 6.0, "drive.quantum_v": 0.5}
    trace = play(make(values), 200)
    expected = np.floor(np.clip(trace["open_loop.voltage"], -6, 6) / 0.5 + 0.5) * 0.5
    assert np.array_equal(trace["drive.voltage"], expected)
    assert np.array_equal(trace["drive.saturated"], (np.abs(trace["open_loop.voltage"]) > 6).astype(float))


def test_sensor_rounds_and_clips():
    values = {**FAST, "sensor": {"kind": "ideal", "noise_um": 0.0, "quantum_um": 0.25, "range_um": 1.5}}
    trace = play(make(values), 400)
    expected = np.clip(np.floor(trace["plant.displacement"] / 0.25 + 0.5) * 0.25, -1.5, 1.5)
    assert np.array_equal(trace["sensor.displacement"], expected)
    assert np.abs(trace["plant.displacement"]).max() > 2


@pytest.mark.parametrize(
    ("limit", "step", "most"), [(7.0, 1.5, 6.0), (6.8, 1.5, 6.0), (0.9, 0.2, 0.8), (1.0, 1.5, 0.0)]
)
def test_no_step_of_a_converter_lies_beyond_its_limit(limit: float, step: float, most: float) -> None:
    trace = play(make({**FAST, "drive": {"limit_v": limit, "quantum_v": step}}), 400)
    assert np.abs(trace["open_loop.voltage"]).max() > limit
    assert np.abs(trace["drive.voltage"]).max() == pytest.approx(most, abs=1e-12)
    assert np.array_equal(trace["drive.saturated"] == 1.0, np.abs(trace["open_loop.voltage"]) > most + 1e-12)
    along = {**AXES_RICH, "drive": {"limit_un": 0.1 * limit, "quantum_un": 0.1 * step}}
    forces = play(make(base=along), 400)
    assert max(np.abs(forces[f"drive.{axis}.force"]).max() for axis in ("x", "y")) <= 0.1 * most + 1e-12
    sensor = {"kind": "ideal", "noise_um": 0.0, "quantum_um": step, "range_um": limit}
    trace = play(make({**FAST, "sensor": sensor, "reference.amplitude_v": 28.0}), 400)
    assert np.abs(trace["plant.displacement"]).max() > min(limit, 6.2)
    assert np.abs(trace["sensor.displacement"]).max() == pytest.approx(most, abs=1e-12)


@given(limit=st.integers(1, 10**6), step=st.integers(1, 10**5), power=st.integers(-5, 2))
def test_a_limit_of_whole_steps_is_reached_and_no_other(limit: int, step: int, power: int) -> None:
    scale = 10.0**power
    found = reach(limit * scale, step * scale)
    assert found == pytest.approx(limit // step * step * scale, rel=1e-12, abs=0.0)
    assert found <= limit * scale and (limit % step != 0 or found == limit * scale)


def test_the_rail_trips_after_its_time():
    values = {"reference": {"kind": "step", "amplitude_v": 40.0, "start_ms": 0.5}, "guard.rail_ms": 0.2}
    board = make({**values, "device.stiffness_n_m": 1.0})
    trace = play(board, 1000)
    assert board.trip is not None and board.trip.signal == "drive.voltage"
    assert len(trace["drive.voltage"]) == 50 + 20 + 1, "20 ticks are allowed, the next is not"


def test_travel_trips_on_the_true_displacement():
    board = make({"reference": {"kind": "constant", "amplitude_v": 29.0}, "guard.travel_um": 12.0})
    trace = play(board, 1000)
    x = np.abs(trace["plant.displacement"])
    assert board.trip is not None and board.trip.signal == "plant.displacement"
    assert np.all(x[:-1] <= 12.0) and x[-1] > 12.0
    assert board.trip.tick == board.tick == len(x)
    assert board.log[-1].kind == "tripped" and board.log[-1].actor == "board"
    assert board.trip.value == trace["plant.displacement"][-1]


def test_reset_starts_blocks_anew_and_keeps_faults_time_and_scores():
    board = make({**RICH, "guard": {"travel_um": 3.0}, "reference.amplitude_v": 9.0}, base=QUIET)
    inject(board, stiffness=0.3)
    play(board, 3000)
    assert board.trip is not None
    tick, steps = board.tick, board.scores()["kalman"].delays
    do(board, {"set": {"reference.amplitude_v": 1.0}})
    do(board, {"reset_trip": True})
    assert board.tick == tick and board.scores()["kalman"].delays == steps
    trace = play(board, 300)
    assert board.trip is None
    assert abs(trace["plant.displacement"][0]) < 0.05 and np.all(trace["faults.stiffness"] == 0.3)


def test_safe_outputs_trip_the_board_for_a_reason_and_repeat_with_the_same_bits():
    board = make(FAST)
    play(board, 300)
    do(board, {"make_safe": "Ada is gone"})
    assert board.trip is not None and (board.trip.tick, board.trip.reason) == (300, "Ada is gone")
    assert board.value("drive.voltage") == 0.0 and board.advance(10).count == 0
    assert [(e.tick, e.kind, e.text) for e in board.log][-1] == (300, "make_safe", "safe outputs: Ada is gone")
    with pytest.raises(InputError, match="tripped already"):
        do(board, {"make_safe": "again"})
    do(board, {"reset_trip": True})
    play(board, 300)
    again = Scenario.load(board.save())
    assert [list(event) for event in again.head.events] == [["at_sample", "make_safe"], ["at_sample", "reset_trip"]]
    result = run(again)
    assert result.digest == board.digest() and result.samples == 600


@pytest.mark.parametrize("chunk", [1, 7, 512])
def test_twins_are_made_safe_and_reset_with_their_board_whatever_the_chunks(chunk):
    twin = {"twins": {"other": {"controller": {"kind": "pid"}}}}
    events = [{"at_sample": 100, "make_safe": "gone"}, {"at_sample": 100, "reset_trip": True}]
    board = build(Scenario.load({**document({**FAST, **twin}), "samples": 300, "events": events}))
    while board.tick < 300:
        board.advance(min(chunk, 300 - board.tick))
    assert board.trip is None and board.twins["other"].trip is None
    live = build(Scenario.load({**document({**FAST, **twin}), "samples": 300}))
    while live.tick < 100:
        live.advance(min(chunk, 100 - live.tick))
    do(live, {"make_safe": "gone"})
    do(live, {"reset_trip": True})
    while live.tick < 300:
        live.advance(min(chunk, 300 - live.tick))
    assert live.digest() == board.digest()
