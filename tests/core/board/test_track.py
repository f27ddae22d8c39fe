"""The past of a board, computed again: rows and digests equal the rows and digests of the straight run."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.board import track
from core.board.board import Board
from core.board.commands import Command, parse_command
from core.board.track import Deed, Track
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.schema import Scenario

TICKS = 3000
MEMORY = 8_000_000
COMMANDS: tuple[dict[str, Any], ...] = (
    {"fault": "added_mass", "severity": 0.05},
    {"fault": "stiffness", "severity": -0.04, "at_sample": 1500},
    {"fault": "damping", "severity": 0.3, "when": "plant.displacement > 0.05"},
    {"heal": "all"},
    {"set": {"reference.amplitude_v": 7.0}},
    {"switch": "pid"},
    {"switch": "mrac"},
)


def bench(**values: Any) -> Board:
    document = get("ch5-seven-step").document
    return build(with_values(Scenario.load({**document, "expect": []}), values))


def twins() -> Board:
    document = get("first-look").document
    return build(Scenario.load({**document, "expect": [], "twins": {"calm": {"controller": {"kind": "open_loop"}}}}))


class Straight:
    """A board that runs on, its track, and its outputs at every tick."""

    def __init__(self, board: Board, deeds: dict[int, list[Command]], most_bytes: int = MEMORY) -> None:
        self.board, self.track = board, Track(board, most_bytes)
        self.rows: list[np.ndarray[Any, Any]] = []
        self.digests: dict[int, str] = {}
        for tick in [*sorted(deeds), TICKS]:
            self.run(tick)
            for command in deeds.get(tick, ()):
                with suppress(InputError):  # not everything is possible at any tick
                    board.apply(command, "somebody")
                    self.track.note(Deed(tick, command, "somebody"))
            self.digests[tick] = board.digest()

    def run(self, tick: int) -> None:
        while self.board.tick < tick:
            rows = self.board.advance(min(97, tick - self.board.tick))
            assert rows.count
            self.rows += [*np.hstack([rows.outputs, rows.taps])]
            self.track.follow(self.board)

    def check(self, tick: int, before: int = 0) -> Board:
        passage = self.track.to(tick, before)
        assert passage.checkpoint.tick <= max(tick - before, self.track.first_tick)
        board = Board.restore(passage.checkpoint)
        for rows in passage.walk(board):
            wanted = np.array(self.rows[rows.first_tick : rows.first_tick + rows.count])
            np.testing.assert_array_equal(np.hstack([rows.outputs, rows.taps]), wanted)
        assert board.tick == tick
        if tick in self.digests:
            assert board.digest() == self.digests[tick]
        return board


@pytest.fixture(autouse=True)
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(track, "EVERY", 200)


@settings(max_examples=20, deadline=None)
@given(
    deeds=st.dictionaries(
        st.integers(0, TICKS - 1), st.lists(st.sampled_from(COMMANDS), min_size=1, max_size=3), max_size=8
    ),
    ticks=st.lists(st.tuples(st.integers(0, TICKS), st.integers(0, 1500)), min_size=1, max_size=6),
    has_twin=st.booleans(),
)
def test_any_tick_of_the_past_is_computed_again_bit_for_bit(
    deeds: dict[int, list[dict[str, Any]]], ticks: list[tuple[int, int]], has_twin: bool
) -> None:
    done = {tick: [parse_command(document) for document in documents] for tick, documents in deeds.items()}
    straight = Straight(twins() if has_twin else bench(), done)
    for tick, before in [*ticks, *((tick, 0) for tick in done)]:
        straight.check(tick, before)


def test_a_copy_goes_on_from_the_past_as_the_board_did() -> None:
    straight = Straight(bench(), {700: [parse_command(COMMANDS[0])]})
    again = straight.check(1000)
    while again.tick < TICKS:
        again.advance(TICKS - again.tick)
    assert again.digest() == straight.digests[TICKS]


def test_what_waits_no_more_does_not_come_again() -> None:
    board = bench()
    straight = Straight(board, {})
    later = parse_command({"fault": "drive_gain", "severity": 0.1, "at_sample": TICKS + 500})
    board.apply(later)
    straight.track.note(Deed(TICKS, later))
    (last,) = [entry for entry in board.pending if entry.tick == TICKS + 500 and entry.command == later]
    board.pending.remove(last)
    straight.track.note(Deed(TICKS, None, "somebody", last.number))
    straight.run(TICKS + 1000)
    straight.digests[TICKS + 1000] = board.digest()
    assert "drive_gain" not in straight.check(TICKS + 1000).faults


def test_old_checkpoints_are_further_apart_and_their_number_is_limited() -> None:
    board = bench()
    straight = Straight(board, {}, most_bytes=1)
    straight.run(20_000)
    ticks = [mark.tick for mark in straight.track._marks]
    assert len(ticks) == track.FEWEST and ticks[0] == 0
    gaps = np.diff(ticks)
    assert gaps[-1] <= 2 * track.EVERY < gaps[0]
    straight.check(4321, 1000)


def test_a_board_that_went_back_has_the_past_before_and_its_own_after() -> None:
    straight = Straight(bench(), {900: [parse_command(COMMANDS[0])]})
    straight.board = straight.check(800)
    straight.track.go_back(straight.board)
    straight.rows = straight.rows[:800]
    straight.run(2000)
    assert "added_mass" not in straight.check(1000).faults
    straight.check(1500, 1400)


def test_the_track_of_a_copy_is_its_own() -> None:
    straight = Straight(bench(), {})
    copy = straight.check(1000)
    own = straight.track.until(copy)
    copy.apply(parse_command(COMMANDS[0]))
    own.note(Deed(1000, parse_command(COMMANDS[0])))
    assert "added_mass" in own.to(1000).board().faults
    assert "added_mass" not in straight.track.to(1000).board().faults
    straight.check(2500)


def test_a_tick_before_the_first_is_refused() -> None:
    board = bench()
    board.advance(100)
    with pytest.raises(InputError, match="tick 99 is not kept, the first is 100"):
        Track(board, MEMORY).to(99)
