"""Thousands of commands: each costs as much as the first, and they take effect in the order of their requests."""

from __future__ import annotations

import cProfile
import pstats
from typing import Any

import pytest

from tests.lab import do, make


def calls(count: int) -> int:
    """How many functions are called to carry out so many commands, one a tick."""
    board = make()
    profile = cProfile.Profile()
    profile.enable()
    for number in range(count):
        fault: dict[str, Any] = {"fault": "added_mass", "severity": 1e-3 + 1e-6 * number}
        do(board, {**(fault if number % 2 else {"heal": "all"}), "at_sample": 10 + number})
    while board.tick < 20 + count:
        board.advance(20 + count - board.tick)
    profile.disable()
    assert len([entry for entry in board.log if entry.kind in ("inject", "heal")]) == count
    return int(pstats.Stats(profile).total_calls)  # type: ignore[attr-defined]


def test_a_command_among_many_costs_no_more_than_one_among_few() -> None:
    calls(50)
    assert calls(800) < 5 * calls(200)


@pytest.mark.parametrize("compiled", [True, False])
def test_commands_of_one_tick_take_effect_in_the_order_asked(compiled: bool) -> None:
    """Also when others were requested in between, and when the first requested command waits for a condition."""
    board = make(compiled=compiled)
    path = "reference.amplitude_v"
    for at, value in ((50, 1.0), (30, 2.0), (50, 3.0), (40, 4.0)):
        do(board, {"set": {path: value}, "at_sample": at})
    do(board, {"set": {path: 5.0}, "at_sample": 20, "when": "plant.displacement > -1e9"})
    do(board, {"set": {path: 6.0}, "at_sample": 21})
    while board.tick < 60:
        board.advance(60 - board.tick)
    done = [(entry.tick, entry.new[path]) for entry in board.log if entry.kind == "set"]
    # what waits for its condition is watched from tick 20 on, behind all that waits already
    assert done == [(21, 6.0), (21, 5.0), (30, 2.0), (40, 4.0), (50, 1.0), (50, 3.0)]


def test_a_change_of_some_parameters_gives_the_wiring_of_a_new_board() -> None:
    """A change takes over packed parameters that packing anew would repeat; state and signals continue."""
    values = {
        "sensor.noise_um": 0.2,
        "drive.limit_v": 20.0,
        "reference.amplitude_v": 3.0,
        "environment.temperature_k": 310.0,
    }
    changed, fresh = make(), make(values)
    for path, value in values.items():
        do(changed, {"set": {path: value}})
    assert (changed.wiring.p == fresh.wiring.p).all()
    assert (changed.wiring.io == fresh.wiring.io).all() and (changed.wiring.table == fresh.wiring.table).all()
