"""Ticks that go into a history without rows: the bits, the log and the history are those of ticks with rows."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from core.board import kept, program
from core.board.board import CHUNK, Board
from core.board.history import History
from core.board.kept import KeptTicks
from core.board.pyramid import WIDEST
from core.board.rows import Rows
from core.board.stored import revived, stored
from core.errors import InputError
from scenarios.library import get
from scenarios.run import build, run
from tests.core.board.test_lost import DIVERGES, REASON
from tests.lab import RICH, STORY, do, make

SLICES = (1, 7, 64, CHUNK, 3 * CHUNK + 100)
COMMANDS: tuple[dict[str, Any], ...] = (
    {"fault": "added_mass", "severity": 0.05},
    {"fault": "damping", "severity": 0.3, "when": "plant.displacement > 0.05"},
    {"fault": "stiffness", "severity": 0.2, "profile": {"kind": "ramp", "duration_ms": 0.4}},
    {"heal": "all"},
    {"switch": "mrac"},
    {"set": {"reference.amplitude_v": 7.0, "sensors.ideal.noise_um": 0.05}},
    {"make_safe": "a test"},
    {"reset_trip": True},
)
DEEDS = st.one_of(
    st.sampled_from(SLICES), st.integers(1, CHUNK), st.sampled_from(COMMANDS), st.sampled_from(["restored", "revived"])
)


def empty(board: Board, ticks: int = 1) -> History:
    return History(board.signals.outputs, len(board.signals.taps), ticks)


def entries(board: Board) -> list[Any]:
    return [(one.tick, one.actor, one.kind, one.text, one.old, one.new) for one in board.log]


def in_rows(board: Board, history: History, n: int) -> Any:
    """Advance a board chunk by chunk with rows, until it trips; return its samples."""
    columns, found = np.arange(len(board.signals)), []
    while n > 0:
        rows = board.advance(n)
        history.append(rows)
        found.append(rows.singles(columns, 0, rows.count))
        n = n - rows.count if rows.count == min(n, CHUNK) else 0
    return np.hstack(found)


def same(one: Board, other: Board) -> None:
    """Compare all that two boards are, every NaN being like any other."""
    for name in ("p", "s", "w", "io"):
        np.testing.assert_array_equal(getattr(one.wiring, name), getattr(other.wiring, name), name)
    assert (one.tick, one.digest(), one.trip, one.used) == (other.tick, other.digest(), other.trip, other.used)
    np.testing.assert_array_equal(one.observer.seen()[0], other.observer.seen()[0])
    assert entries(one) == entries(other)


def same_past(one: History, other: History) -> None:
    """Compare all bits that two histories keep and show."""
    assert (one.first_tick, one.end_tick) == (other.first_tick, other.end_tick)
    for name in ("_ring", "_low", "_high"):
        first, second = (getattr(history, name) for history in (one, other))
        alike = first.view(np.uint32) == second.view(np.uint32)
        assert np.all(alike | (np.isnan(first) & np.isnan(second))), name


def again(board: Board, way: str) -> Board:
    """Return a board that continues from another."""
    if way == "restored":
        return Board.restore(board.checkpoint())
    copy = revived(stored(board))
    copy.log = board.log.copy()
    return copy


@settings(max_examples=30)
@given(deeds=st.lists(DEEDS, max_size=30))
@example(
    deeds=[7, COMMANDS[0], 512, COMMANDS[3], 512, 64, "restored", COMMANDS[0], 1, 512, COMMANDS[6], 64, COMMANDS[7], 7]
)
def test_ticks_in_a_history_are_the_ticks_of_rows_to_the_bit(deeds: list[Any]) -> None:
    boards = [make(base=RICH), make(base=RICH)]
    histories = [empty(board) for board in boards]
    for deed in [*deeds, 64]:
        if isinstance(deed, int):
            first = boards[0].tick
            samples, ticks = in_rows(boards[0], histories[0], deed), boards[1].advance_into(histories[1], deed)
            assert (first, boards[0].tick - first) == (ticks.first_tick, ticks.count)
            if ticks.count:
                columns = np.arange(len(boards[0].signals))
                np.testing.assert_array_equal(samples, ticks.singles(columns, 0, ticks.count))
        elif isinstance(deed, dict):
            for board in boards:
                with suppress(InputError):
                    do(board, deed)
        else:
            boards = [again(board, deed) for board in boards]
    same(*boards)
    same_past(*histories)


@pytest.mark.parametrize("ticks", SLICES)
def test_findings_in_the_middle_of_a_slice_are_those_of_a_headless_run(ticks: int) -> None:
    """The seven steps find their faults at ticks that no slice ends at."""
    scenario = get("ch5-seven-step")
    headless, board = run(scenario).board, build(scenario)
    history = empty(board)
    while board.tick < headless.tick:
        board.advance_into(history, min(ticks, headless.tick - board.tick))
    assert board.digest() == headless.digest() and entries(board) == entries(headless)
    found = [one.tick for one in board.log if one.kind == "recognised"]
    assert len(found) >= 6 and any(tick % 64 not in (0, 63) for tick in found)


@pytest.mark.parametrize("ticks", SLICES)
def test_commands_between_ticks_take_effect_where_they_do_with_rows(ticks: int) -> None:
    boards = [make(commands=STORY, base=RICH) for _ in range(2)]
    histories = [empty(board) for board in boards]
    while boards[0].tick < 600:
        n = min(ticks, 600 - boards[0].tick)
        in_rows(boards[0], histories[0], n)
        boards[1].advance_into(histories[1], n)
    same(*boards)
    same_past(*histories)


@pytest.mark.parametrize("ticks", SLICES)
def test_a_lost_state_trips_the_board_where_it_does_with_rows(ticks: int) -> None:
    boards = [make(DIVERGES, base=RICH) for _ in range(2)]
    history = empty(boards[1])
    while boards[0].advance(ticks).count:
        pass
    while boards[1].advance_into(history, ticks).count:
        pass
    assert boards[1].trip is not None and boards[1].trip.reason == REASON
    same(*boards)


def test_a_slice_is_never_longer_than_what_each_history_keeps() -> None:
    board = make(base=RICH)
    history = empty(board)
    assert board.advance_into(history, 3 * WIDEST).count == WIDEST
    assert board.advance_into(history, 3 * WIDEST).count == WIDEST
    assert history.end_tick - history.first_tick >= WIDEST


def test_a_full_history_goes_round_and_begins_anew_after_a_jump() -> None:
    start = make(base=RICH)
    boards = [Board.restore(start.checkpoint()) for _ in range(2)]
    histories = [empty(board) for board in boards]
    for to in (2 * histories[0].capacity + 100, 1000, 3000):
        if to == 1000:  # back to the beginning, where the histories do not end
            boards = [Board.restore(start.checkpoint()) for _ in range(2)]
        while boards[0].tick < to:
            histories[0].append(boards[0].advance(CHUNK))
            boards[1].advance_into(histories[1], CHUNK)
    assert histories[1].first_tick == 0 and histories[1].end_tick == boards[1].tick
    names = list(range(len(start.signals)))
    for span in (40, 700, boards[0].tick):
        columns = [history.columns(names, boards[0].tick - span, boards[0].tick, 90) for history in histories]
        np.testing.assert_array_equal(*columns)
    same(*boards)


def test_a_history_that_another_continues_from_has_what_was_written() -> None:
    board = make(base=RICH)
    history, other = empty(board), empty(board, 4096)
    for _ in range(20):
        board.advance_into(history, CHUNK)
    other.adopt(history, board.tick - 1000, board.tick)
    names = list(range(len(board.signals)))
    np.testing.assert_array_equal(other.read(names, 0, board.tick), history.read(names, board.tick - 1000, board.tick))


def test_it_stops_behind_a_tick_in_which_a_followed_number_changes_but_not_for_one_that_stays_nan(monkeypatch) -> None:
    board = make(base=RICH)
    history, counts = empty(board), []

    def counted(*arguments: Any) -> tuple[int, int]:
        counts.append(real(*arguments))
        return counts[-1]

    real = kept.run
    monkeypatch.setattr(kept, "run", counted)
    board.advance_into(history, 100)
    ticks = {entry.tick for entry in board.log}
    ends = np.cumsum([ran for ran, _ in counts]).tolist()
    assert ticks and {tick + 1 for tick in ticks} <= {*ends}
    assert {why for _, why in counts[:-1]} == {kept.CHANGED} and counts[-1][1] == program.DONE
    still = next(signal for signal in board.signals if signal.kind == "tap" and signal.block == "single_beam")
    board.observer._columns, board.observer._last = np.array([still.index]), np.array([np.nan])
    board.wiring.w[board.wiring.index[still.name]] = np.nan
    counts.clear()
    board.advance_into(history, 100)
    assert counts == [(100, program.DONE)]


def test_rows_and_a_history_give_the_same_numbers_in_single_precision() -> None:
    board = make(base=RICH)
    rows = board.advance(100)
    history = empty(board)
    history.append(rows)
    ticks = KeptTicks(0, 100, history)
    columns = np.array([3, board.signals.outputs + 2, 0])
    expected = np.hstack([rows.outputs, rows.taps])[20:70, columns].T.astype(np.float32)
    for one in (rows, ticks):
        np.testing.assert_array_equal(one.singles(columns, 20, 70), expected)
    assert Rows.of(0, np.zeros((0, 5)), 2).singles(np.array([1]), 0, 0).shape == (1, 0)
