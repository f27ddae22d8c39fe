"""Inverse commands: after a command and its inverse every parameter of every block is as before."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.board.board import Board
from core.board.commands import parse_command
from core.board.inverse import inverse
from core.errors import InputError
from scenarios.library import get
from scenarios.run import build
from tests.lab import make

COMMANDS: list[dict[str, Any]] = [
    {"fault": "added_mass", "severity": 0.05},
    {"fault": "added_mass", "severity": 0.1, "profile": {"kind": "ramp", "duration_ms": 2.0}},
    {"fault": "stiffness", "severity": -0.05, "profile": {"kind": "intermittent", "period_ms": 1.0}},
    {"fault": "sensor_hum", "severity": 0.1, "parameters": {"frequency_hz": 60.0}},
    {"heal": "all"},
    {"heal": ["added_mass"]},
    {"switch": "pid"},
    {"switch": "open_loop"},
    {"switch": "pid", "cold": True},
    {"set": {"reference.kind": "chirp"}},
    {"set": {"reference.kind": "square", "reference.frequency_hz": 500.0}},
    {"set": {"reference": {"kind": "sine", "amplitude_v": 3.0}}},
    {"set": {"reference.amplitude_v": 4.0, "environment.temperature_k": 310.0}},
    {"set": {"controller.kind": "pid"}},
    {"set": {"sensor.noise_um": 0.1}},
    {"set": {"drive.limit_v": 20.0, "guard.rail_ms": 3.0}},
]


def state(board: Board) -> tuple[Any, ...]:
    """Everything a command can change: parameters of all blocks, driving controllers, active faults (without their
    first tick)."""
    params = [
        (one.key, one.block.name, one.params) for one in board.wiring.instances if not one.key.startswith("faults")
    ]
    faults = {name: p.model_dump(exclude={"start_tick"}) for name, p in board.faults.items()}
    return params, dict(board.spec.driving), board.spec.measuring, faults, board.wiring.io.tolist()


@settings(max_examples=60, deadline=None)
@given(st.lists(st.sampled_from(COMMANDS), min_size=1, max_size=6))
def test_inverses_in_reverse_order_give_back_the_bench_of_before(documents: list[dict[str, Any]]) -> None:
    board = make()
    before = [state(board)]
    ways = []
    for document in documents:
        command, spec = parse_command(document), board.spec
        try:
            entry = board.apply(command)
        except InputError:
            continue  # there already, or not there to heal
        ways.append(inverse(command, entry, spec.document))
        before.append(state(board))
    for way in reversed(ways):
        assert state(board) == before.pop()
        for command in way:
            board.apply(command)
    assert state(board) == before.pop() and not before


@pytest.mark.parametrize("command", COMMANDS, ids=str)
def test_every_command_of_these_is_taken(command: dict[str, Any]) -> None:
    board = make()
    board.apply(parse_command({"fault": "added_mass", "severity": 0.02}))
    if command != {"switch": "open_loop"}:  # it drives already
        board.apply(parse_command(command))


@pytest.mark.parametrize(
    "command",
    [{"set": {"rate.deg_per_s": 50.0}}, {"set": {"rate.kind": "sine"}}, {"switch": "drive_tracking"}],
    ids=str,
)
def test_a_gyroscope_is_taken_back_too(command: dict[str, Any]) -> None:
    board = build(get("gyro-first-look"))
    done, spec, was = parse_command(command), board.spec, state(board)
    entry = board.apply(done)
    assert state(board) != was
    for one in inverse(done, entry, spec.document):
        board.apply(one)
    assert state(board) == was
