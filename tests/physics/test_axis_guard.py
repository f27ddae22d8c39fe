"""A force that alternates and has run away stops the board; a force that touches its limit does not."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.lab import make, play

LIMIT, RAIL_MS, HZ = 10.0, 20.0, 1000.0
BENCH: dict[str, Any] = {
    "sample_rate_khz": 100,
    "seed": 1,
    "device": {"id": "gyro-c"},
    "plant": {"model": "gyroscope", "thermal_noise": False},
    "slots": {"drive": "forced_drive"},
    "controller": {"kind": "open_loop_rate"},
    "drive": {"limit_un": LIMIT},
    "guard": {"rail_ms": RAIL_MS, "travel_um": 1000.0},
}


def share_at_limit(swing: float) -> float:
    """Part of a period in which |A sin| is over 1."""
    return 1.0 - 2.0 / math.pi * math.asin(1.0 / swing)


def board_under(swing: float, **values: Any) -> Any:
    force = {"force_un": swing * LIMIT, "frequency_hz": HZ}
    return make({**BENCH, "controllers": {"forced_drive": force}, **values}, base={})


@pytest.mark.parametrize("swing", [1.2, 2.0, 10.0])
def test_a_force_over_its_limit_most_of_the_time_stops_the_board(swing: float) -> None:
    board = board_under(swing)
    share = share_at_limit(swing)
    expected_ms = RAIL_MS / (share - 0.25 * (1.0 - share))
    play(board, round(expected_ms * 100) + 300)
    assert board.trip is not None and board.trip.signal == "drive.x.force"
    assert board.trip.time_ms == pytest.approx(expected_ms, rel=0.05, abs=1.0)  # within a period of 1 ms


def test_a_force_over_its_limit_at_the_crests_is_endured() -> None:
    assert share_at_limit(1.03) < 0.2
    board = board_under(1.03)
    play(board, 50_000)
    assert board.trip is None


def test_an_adaptive_law_that_runs_away_stops_the_board() -> None:
    """Twenty times its usual gain of the velocity error pushes back more than was too much."""
    law = {"kind": "adaptive_rate", "velocity_gain": 400.0}
    values = {"slots": {"drive": "drive_tracking"}, "controller": law}
    board = make({**BENCH, **values, "drive": {}, "guard": {}}, base={})
    play(board, 50_000)
    assert board.trip is not None and board.trip.signal == "drive.x.force"
