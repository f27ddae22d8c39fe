"""The loop in plain numpy gives the same results as the board, and takes much longer."""

from __future__ import annotations

import numpy as np
import pytest

from core.board.board import CHUNK
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.speed.naive import KEYS, NaiveLoop, naive_sample
from scenarios.speed.timing import loop_cost
from tests.lab import play

QUIET = {
    "events": [],
    "plant.thermal_noise": False,
    "plant.drive_noise_v": 0.0,
    "sensor.noise_um": 0.0,
    "diagnosers.kalman.sensor_noise_um": 0.05,
    "expect": [],
}


def test_the_loop_is_the_board():
    board = build(with_values(get("ch5-seven-step"), QUIET))
    trace = play(board, CHUNK)
    loop = NaiveLoop(board, 0.0)
    names = ("reference.voltage", "model.displacement", "drive.voltage")
    given = [trace[name] for name in names]
    applied = np.concatenate([[0.0], given[2][:-1]])
    found = np.array([[*loop.sample(*one), *loop.probability] for one in zip(given[0], given[1], applied, strict=True)])
    banks = [name for name in trace if name.startswith("kalman.probability.")]
    for column, name in enumerate(["plant.displacement", "pid.voltage", "mrac.voltage", *banks]):
        np.testing.assert_allclose(found[:, column], trace[name], atol=1e-7, err_msg=name)


@pytest.mark.long
def test_the_board_is_much_faster():
    board = build(with_values(get("ch5-seven-step"), {"events": [], "plant.drive_noise_v": 0.01}))
    board.advance(CHUNK)
    assert naive_sample(board, 0.01)() > 100 * loop_cost(board, [*KEYS])
