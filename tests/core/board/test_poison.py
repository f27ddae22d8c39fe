"""A poisoned state trips the board at its next tick, and the outputs are safe then."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.board.board import Board
from scenarios.library import get
from scenarios.run import build

POISON = (math.nan, math.inf, -math.inf)


def running(name: str) -> Board:
    """Return a board that has run for a while."""
    board = build(get(name))
    while board.tick < 200:
        board.advance(200 - board.tick)
    assert board.trip is None
    return board


def outputs(board: Board) -> list[float]:
    """Return the outputs of the drives."""
    drives = [one for one in board.wiring.instances if one.prefix.split(".")[0] == "drive"]
    return [board.value(f"{one.prefix}.{port.name}") for one in drives for port in one.block.outputs]


@pytest.mark.parametrize("poison", POISON)
@pytest.mark.parametrize("scenario", ["ch5-seven-step", "ch3-mrac-spring-x2", "ch3-stvsc-pull-in", "gyro-diagnosis"])
def test_a_plant_that_is_no_number_trips_the_board_at_the_next_tick(scenario: str, poison: float) -> None:
    board = running(scenario)
    plant = next(one for one in board.wiring.instances if one.prefix.split(".")[0] == "plant")
    for port in plant.block.outputs:
        board.wiring.w[board.wiring.index[f"{plant.prefix}.{port.name}"]] = poison
    board.wiring.state_of(plant.key)[:] = poison
    assert board.advance(100).count == 1
    assert board.trip is not None and board.trip.tick == 201
    assert outputs(board) == [0.0] * len(outputs(board)) != []


@pytest.mark.parametrize("poison", POISON)
def test_a_controller_that_is_no_number_trips_the_board_at_the_next_tick(poison: float) -> None:
    board = running("ch3-mrac-spring-x2")
    board.wiring.state_of(board.spec.active)[:] = poison
    assert board.advance(100).count == 1
    assert board.trip is not None and "not a finite number" in board.trip.reason
    assert board.trip.value is None and outputs(board) == [0.0] * len(outputs(board))
    assert np.isfinite(board.trip.time_ms)


def test_a_limit_that_is_passed_trips_the_board_at_that_tick() -> None:
    board = running("ch5-seven-step")
    limit = board.spec.guard.params.travel_um  # type: ignore[attr-defined]
    board.wiring.w[board.wiring.index["plant.displacement"]] = 2.0 * limit
    assert board.advance(100).count == 1
    assert board.trip is not None and board.trip.signal == "plant.displacement"
