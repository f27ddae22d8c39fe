"""The peers of the gyroscope's speed move as its plant does, which is much faster."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest
from scipy.linalg import expm

from core.board.board import Board
from core.device.two_axis import TwoAxis
from scenarios.speed import gyroscope
from scenarios.speed.timing import loop_cost


def test_the_system_of_the_peers_is_the_plant():
    values: dict[str, Any] = {
        **gyroscope.ONE,
        "plant": {"model": "gyroscope", "thermal_noise": False, "initial_x_um": 5.0, "initial_y_velocity_um_ms": 0.3},
        "slots": {"drive": "forced_drive"},
        "controller": {"kind": "open_loop_rate"},
        "controllers": {"forced_drive": {"force_un": 0.0}},
        "readouts": {},
    }
    board = Board(values)
    step = expm(gyroscope.system_of(cast(TwoAxis, board.spec.nominal)) * board.dt_ms)
    x = np.array([5.0, 0.0, 0.0, 0.3, 0.0, 0.0])
    rows = board.advance(300)
    names = ("plant.x", "plant.y", "plant.x_velocity", "plant.y_velocity")
    found = rows.outputs[:, [board.signals.index(name) for name in names]]
    for row in found:
        np.testing.assert_allclose(row, x[:4], atol=1e-10)
        x = step @ x


@pytest.mark.long
def test_the_plant_is_much_faster_than_its_peers():
    board = gyroscope.running(gyroscope.ONE)
    device = cast(TwoAxis, board.spec.nominal)
    own = loop_cost(board, ["plant"])
    assert gyroscope.solved_sample(device, board.dt_ms)() > 500 * own
    assert gyroscope.stepped_sample(device, board.dt_ms)() > 2 * own
