"""Drive, converter and guard: limits, rounding, trips and the way out of them."""

from __future__ import annotations

import numpy as np

from tests.lab import QUIET, RICH, do, inject, make, play

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
