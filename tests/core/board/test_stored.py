"""A board continues from plain data, written as JSON and arrays, bit for bit."""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.block import Block
from core.board.board import Board
from core.board.commands import parse_command
from core.board.instances import instances
from core.board.stored import Stored, revived, stored
from core.errors import InputError
from scenarios.library import get, ids
from scenarios.run import build
from scenarios.schema import Scenario


def written(kept: Stored) -> Stored:
    """Return the data after a file."""
    file = io.BytesIO()
    np.savez(file, **kept.arrays)
    file.seek(0)
    arrays = dict(np.load(file, allow_pickle=False))
    return Stored(json.loads(json.dumps(kept.document)), arrays)


def same(first: Board, second: Board, ticks: int) -> None:
    """Both continue alike: rows, log, digest, scores."""
    seen = first.log.last, second.log.last
    for _ in range(ticks // 256):
        rows, others = first.advance(256), second.advance(256)
        assert rows.outputs.tobytes() == others.outputs.tobytes()
        assert rows.taps.tobytes() == others.taps.tobytes()
    assert first.tick == second.tick and first.digest() == second.digest()
    logs = [[entry.model_dump(exclude={"seq"}) for entry in list(b.log) if entry.seq > at] for b, at in zip((first, second), seen, strict=True)]  # fmt: skip  # noqa: E501
    assert logs[0] == logs[1]
    assert first.scores() == second.scores() and first.save() == second.save()


def test_scenarios_with_every_block_of_the_library_go_on_from_their_middle() -> None:
    seen: set[type[Block]] = set()
    for scenario in map(get, ids()):
        blocks = set() if scenario.study is not None else {one.block for one in instances(scenario.spec)}
        if not blocks <= seen:
            seen |= blocks
            goes_on_from_its_middle(scenario, 512)


@pytest.mark.long
def test_every_scenario_goes_on_from_its_middle() -> None:
    for scenario in map(get, ids()):
        if scenario.study is None:
            goes_on_from_its_middle(scenario, 1024)


def goes_on_from_its_middle(scenario: Scenario, ticks: int) -> None:
    board = build(scenario)
    for _ in range(5):
        board.advance(min(512, (scenario.samples or 4000) // 8))
    same(board, revived(written(stored(board))), ticks)


COMMANDS = st.sampled_from(
    [
        {"fault": "added_mass", "severity": 0.05},
        {"fault": "damping", "severity": 0.3, "profile": {"kind": "ramp", "duration_ms": 1.0}},
        {"fault": "sensor_bias", "severity": 0.2},
        {"heal": "all"},
        {"heal": ["damping"]},
        {"switch": "pid"},
        {"switch": "mrac", "cold": True},
        {"set": {"reference.amplitude_v": 9.0}},
        {"set": {"controllers.pid.gain": 2.0}},
        {"set": {"sensor.kind": "capacitive"}},
        {"set": {"diagnosers.kalman.probability_floor": 0.01}},
        {"fault": "stiffness", "severity": 0.1, "when": "plant.displacement > 1.0"},
        {"fault": "shock", "severity": 0.5, "at_ms": 9.0},
        {"set": {"guard.travel_um": 0.5}},
        {"reset_trip": True},
    ]
)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 300), COMMANDS), max_size=10), st.integers(0, 400))
def test_it_goes_on_whatever_was_done(what: list[tuple[int, dict[str, Any]]], after: int) -> None:
    board = build(get("first-look"))
    for ticks, command in what:
        board.advance(ticks)
        try:
            board.apply(parse_command(command), "api")
        except InputError:
            continue
    board.advance(after)
    same(board, revived(written(stored(board))), 1024)


def test_twins_go_on_too() -> None:
    document = {**get("first-look").document, "twins": {"other": {"controller": {"kind": "pid"}}}}
    board = build(Scenario.load(document))
    board.advance(500)
    board.apply(parse_command({"fault": "added_mass", "severity": 0.05}), "api")
    board.advance(300)
    board.apply(parse_command({"switch": "mrac"}), "api")
    same(board, revived(written(stored(board))), 1024)


def test_what_is_stored_is_a_copy() -> None:
    board = build(get("first-look"))
    board.advance(100)
    kept = stored(board)
    digest, before = board.digest(), json.dumps(kept.document)
    board.advance(100)
    assert revived(kept).digest() == digest and json.dumps(kept.document) == before


def test_numbers_of_another_version_are_refused() -> None:
    board = build(get("first-look"))
    kept = stored(board)
    short = Stored(kept.document, {**kept.arrays, "s": kept.arrays["s"][:-1]})
    with pytest.raises(InputError, match="other numbers"):
        revived(short)
