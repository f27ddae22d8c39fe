"""Segments of a board as one function: the bits of the walk, with any commands and at any moment."""

from __future__ import annotations

import gc
import pickle
import weakref
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.block import Block
from core.board.board import Board
from core.board.ensemble import Ensemble
from core.board.ensemble import make as make_all
from core.board.segments import SharedSegment
from core.board.stored import revived, stored
from core.board.tuning import tuned
from core.board.wiring import wire
from core.compile.machine import native
from core.compile.segment import SegmentStep, code_of, piece
from core.errors import InputError
from scenarios.library import library
from scenarios.run import build
from scenarios.speed.boards import EVERYTHING, seven_step_bench
from tests.lab import AXES_RICH, AXES_STORY, RICH, STORY, do, document, make

COMMANDS: tuple[dict[str, Any], ...] = (
    {"fault": "added_mass", "severity": 0.05},
    {"fault": "stiffness", "severity": 0.2, "profile": {"kind": "ramp", "duration_ms": 0.4}},
    {"fault": "damping", "severity": 0.3, "when": "plant.displacement > 0.05"},
    {"heal": "all"},
    {"switch": "mrac"},
    {"switch": "pid", "cold": True},
    {"set": {"reference.amplitude_v": 7.0, "sensors.ideal.noise_um": 0.05}},
    {"set": {"plant.drive_noise_v": 0.05, "environment.temperature_k": 320.0}},
    {"make_safe": "a test"},
    {"reset_trip": True},
)
loaded: list[SharedSegment] = []
"""Segments that stay loaded, so that no test waits for them twice."""


def load(board: Board) -> Board:
    """Let a board fuse, with the code of all its segments."""
    board.fuse()
    for segment in board.unfused:
        loaded.append(segment)
        segment.load(code_of(segment.steps))
    return board


@pytest.fixture(scope="module", autouse=True)
def code() -> Any:
    load(make(base=RICH))
    yield
    loaded.clear()


def same(one: Board, other: Board) -> None:
    """Compare all that two boards are, every NaN being like any other."""
    for name in ("p", "s", "w", "io"):
        np.testing.assert_array_equal(getattr(one.wiring, name), getattr(other.wiring, name), name)
    assert (one.tick, one.digest(), one.trip) == (other.tick, other.digest(), other.trip)
    entries = [[(entry.tick, entry.kind, entry.text) for entry in board.log] for board in (one, other)]
    assert entries[0] == entries[1]


def step(boards: list[Board], ticks: int) -> None:
    """Advance boards by one slice; their rows are the same."""
    first, second = (board.advance(ticks) for board in boards)
    assert (first.first_tick, first.count) == (second.first_tick, second.count)
    for name in ("outputs", "taps", "idle"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


def everywhere(boards: list[Board], command: dict[str, Any]) -> None:
    """Give a command to boards; all of them refuse it, or none does."""
    taken = []
    for board in boards:
        with suppress(InputError):
            do(board, command)
            taken.append(board)
    assert taken in ([], boards)


def again(board: Board, way: str) -> Board:
    """Return a board that continues from another."""
    if way == "restored":
        return Board.restore(board.checkpoint())
    copy = revived(stored(board))
    copy.log = board.log.copy()
    copy.fuses = board.fuses
    return copy


DEEDS = st.one_of(st.integers(1, 90), st.sampled_from(COMMANDS), st.sampled_from(["fuse", "restored", "revived"]))


@settings(max_examples=60, deadline=None)
@given(deeds=st.lists(DEEDS, max_size=40), late=st.integers(0, 30))
def test_a_fused_board_is_the_walk_to_the_bit(deeds: list[Any], late: int) -> None:
    """With any commands, continued from copies of itself, and at any slice in which it takes the code."""
    boards = [make(base=RICH), make(base=RICH)]
    for number, deed in enumerate([*deeds, 64]):
        if number == late:
            boards[1].fuse()
        if isinstance(deed, int):
            step(boards, deed)
        elif isinstance(deed, dict):
            everywhere(boards, deed)
        elif deed == "fuse":
            boards[1].fuse()
        else:
            boards = [again(board, deed) for board in boards]
    same(*boards)


def test_every_parameter_that_may_change_changes_a_fused_board_as_it_changes_the_walk() -> None:
    """The segments stay the same, unless a sensor begins to run."""
    boards, others = [make(base=RICH), load(make(base=RICH))], []
    values = {path: value for path, value in tuned(boards[0].spec).items() if isinstance(value, bool | float)}
    for path, value in values.items():
        everywhere(boards, {"set": {path: not value if isinstance(value, bool) else 1.01 * value}})
        step(boards, 3)
        if boards[1].unfused:
            others.append(path)
            everywhere(boards, {"set": {path: value}})
            step(boards, 3)
        assert not boards[1].unfused
    assert len(values) > 100 and {path.split(".")[-1] for path in others} == {"always"}
    same(*boards)


def test_the_rows_of_a_segment_run_until_its_code_is_loaded_and_then_are_one_row() -> None:
    board = make(base=RICH)
    do(board, {"fault": "added_mass", "severity": 0.05})
    rows = len(board.walk.table)
    board.fuse()
    board.walk.parts = [
        part._replace(segment=part.segment and SharedSegment(part.segment.steps)) for part in board.walk.parts
    ]
    board.walk._join()
    assert len(board.walk.table) == rows and len(board.unfused) == 2
    first, second = board.unfused
    board.advance(10)
    second.load(code_of(second.steps))
    assert len(board.walk.table) == rows, "it takes code at a tick edge of its own"
    board.advance(10)
    assert len(board.walk.table) == rows - len(second.steps) + 1 and board.unfused == [first]
    straight = make(base=RICH, commands=[{"fault": "added_mass", "severity": 0.05}])
    straight.advance(20)
    same(straight, board)


def test_no_fault_and_no_switch_makes_another_segment() -> None:
    board = load(make(base=RICH))
    before = [part.segment for part in board.walk.parts]
    for command in COMMANDS[:7]:
        do(board, command)
        board.advance(5)
    assert [part.segment for part in board.walk.parts if part.segment] == before
    assert {len(part.segment.steps) for part in board.walk.parts if part.segment} == {3, len(board.walk.running) - 3}


def test_boards_share_a_segment_which_ends_with_the_last_of_them() -> None:
    values = {"sample_rate_khz": 50}
    one, other = make(values), make(values)
    one.fuse(), other.fuse()
    assert one.unfused == other.unfused != []
    kept = weakref.ref(one.unfused[0])
    del one
    gc.collect()
    assert kept() is not None
    del other
    gc.collect()
    assert kept() is None


def test_a_segment_is_named_by_its_steps_and_comes_through_a_pipe() -> None:
    (first, *_), other = make(base=RICH).walk.parts or load(make(base=RICH)).walk.parts, make(base=RICH)
    assert first.segment is not None
    steps = first.segment.steps
    assert pickle.loads(pickle.dumps(steps)) == steps
    name = piece(steps).name_for(native())
    assert piece(tuple(steps)).name_for(native()) == name
    for field, value in (("every", 2), ("p", 7), ("s", 7), ("io", 7), ("ports", ())):
        assert piece((SegmentStep(**{**vars(steps[0]), field: value}), *steps[1:])).name_for(native()) != name
    assert piece(steps[1:]).name_for(native()) != name and other.unfused == []


def test_a_unit_of_a_document_runs_by_itself() -> None:
    board = make(base=RICH)
    row = board.wiring.row("mrac")
    block: Any = type("Own", (board.wiring.instances[row].block,), {"text": "a unit"})
    board.wiring.instances[row] = board.wiring.instances[row]._replace(block=block)
    board.fuse()
    alone = [part for part in board.walk.parts if part.segment is None]
    assert [board.walk.running[part.rows] for part in alone] == [[row]]


def test_an_uncompiled_board_does_not_fuse() -> None:
    board = make(base=RICH, compiled=False)
    board.fuse()
    assert not board.unfused and not board.fuses


def test_twins_fuse_too() -> None:
    twins = {"calm": {"controller": {"kind": "open_loop"}}, "other": {"sensor": {"kind": "ideal", "noise_um": 0.5}}}
    boards = [make_all({**document(base=RICH), "twins": twins}) for _ in range(2)]
    load(boards[1])
    assert isinstance(boards[1], Ensemble) and not boards[1].unfused
    for command in STORY:
        everywhere(boards, command)
    for ticks in (100, 60):
        step(boards, ticks)
    boards[1] = Board.restore(boards[1].checkpoint())  # with two faults, whose rows are by themselves
    assert all(twin.fuses and len(twin.walk.table) == 4 for twin in boards[1].twins.values())
    for ticks in (200, 60):
        step(boards, ticks)
    same(*boards)


def played(boards: list[Board], ticks: int) -> None:
    while boards[0].tick < ticks and boards[0].trip is None:
        step(boards, 97)
        load(boards[1])  # also the code of segments that a command has changed


@pytest.mark.long
def test_a_gyroscope_with_everything_is_fused_to_the_bit() -> None:
    boards = [make(base=AXES_RICH, commands=AXES_STORY) for _ in range(2)]
    load(boards[1])
    played(boards, 2000)
    same(*boards)


@pytest.mark.long
@pytest.mark.timeout(1800)
def test_every_block_of_the_library_is_fused_to_the_bit() -> None:
    """With all blocks of a scenario, as a live bench has them, and its events."""
    seen = set[type[Block]]()
    for scenario in library():
        blocks = {instance.block for instance in wire(scenario.spec).instances}
        if not blocks <= seen:
            seen |= blocks
            boards = [build(scenario) for _ in range(2)]
            load(boards[1])
            played(boards, 3000)
            same(*boards)


@pytest.mark.long
def test_the_bench_with_everything_on_it_is_fused_to_the_bit() -> None:
    """Every command, with a change of each kind of block that may be exchanged while a board runs."""
    exchanged = ({"reference": {"kind": "multi_sine"}}, {"sensor.kind": "capacitive"}, {"sensor.kind": "ideal"})
    boards = [seven_step_bench(EVERYTHING) for _ in range(2)]
    load(boards[1])
    for command in (*COMMANDS, *({"set": values} for values in exchanged), *COMMANDS):
        everywhere(boards, command)
        step(boards, 300)
        load(boards[1])
    same(*boards)
