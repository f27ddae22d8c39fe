"""The history of a board against plain arrays."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from core.board.history import History
from core.board.rows import Rows
from tests.lab import RICH, make

SIGNALS = 3


def signal(n: int, seed: int = 0, first: int = 0) -> np.ndarray:
    random = np.random.default_rng(seed)
    walk = np.cumsum(random.normal(size=(n, SIGNALS)), axis=0)
    return walk + 50 * np.sin(0.01 * (first + np.arange(n)))[:, None]


def feed(history: History, data: np.ndarray, chunks: list[int], first: int = 0) -> None:
    at = 0
    while at < len(data):
        n = min(chunks[0], len(data) - at)
        chunks = [*chunks[1:], chunks[0]]
        part = data[at : at + n]
        history.append(Rows.of(first + at, part, 2))
        at += n


def expected_columns(data: np.ndarray, kept: range, start: int, stop: int, columns: int) -> np.ndarray:
    """Minimum and maximum of column c over its ticks, at least one, that are kept."""
    out = np.full((SIGNALS, 2, columns), np.nan, dtype=np.float32)
    for c in range(columns):
        a = start + (stop - start) * c // columns
        b = max(start + (stop - start) * (c + 1) // columns, a + 1)
        a, b = max(a, kept.start), min(b, kept.stop)
        if a < b:
            part = data[a:b].astype(np.float32)
            out[:, 0, c], out[:, 1, c] = part.min(axis=0), part.max(axis=0)
    return out


@settings(max_examples=40)
@given(
    n=st.integers(1, 30_000),
    chunks=st.lists(st.integers(1, 512), min_size=1, max_size=5),
    spans=st.lists(st.tuples(st.floats(-0.2, 1.2), st.floats(0.0, 1.2), st.integers(1, 900)), min_size=1, max_size=6),
)
def test_columns_against_plain_arrays(n, chunks, spans):
    history = History(2, SIGNALS - 2, 8192)
    assert history.capacity == 8192 + 4096
    data = signal(n)
    feed(history, data, [max(chunk, n // 400 + 1) for chunk in chunks])
    assert history.end_tick == n
    assert n - history.first_tick >= min(n, 8192)
    kept = range(history.first_tick, n)
    for share, width, columns in spans:
        start = int(share * n)
        stop = start + max(1, int(width * n))
        found = history.columns([0, 1, 2], start, stop, columns)
        assert found.dtype == np.float32
        np.testing.assert_array_equal(found, expected_columns(data, kept, start, stop, columns))


@settings(max_examples=40)
@given(
    n=st.integers(1, 30_000),
    capacity=st.sampled_from([4096, 8192, 30_000]),
    back=st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)),
    more=st.integers(0, 700),
    columns=st.integers(1, 900),
)
@example(n=8192, capacity=8192, back=(0.0, 1.0), more=0, columns=7)  # ends of buckets of every level
@example(n=5120, capacity=4096, back=(0.0, 0.5), more=64, columns=40)
def test_ticks_of_another_history_are_as_if_they_had_been_appended(n, capacity, back, more, columns):
    source, history = History(2, SIGNALS - 2, 8192), History(2, SIGNALS - 2, capacity)
    data = signal(n + more)
    feed(source, data[:n], [512])
    stop = n - int(back[0] * min(n, 4000))
    start = max(0, stop - int(back[1] * 4096))
    history.adopt(source, start, stop)
    begin = max(start, source.first_tick)
    if begin >= stop:
        assert (history.first_tick, history.end_tick) == (0, 0)
        return
    feed(history, data[stop : stop + more], [100], stop)
    end = min(stop + more, len(data))
    kept = range(max(begin, history.first_tick), end)
    assert history.first_tick == kept.start and history.end_tick == end
    found = history.columns([0, 1, 2], start - 50, end + 50, columns)
    np.testing.assert_array_equal(found, expected_columns(data, kept, start - 50, end + 50, columns))
    np.testing.assert_array_equal(history.read([2, 0], start, end), data[kept.start : end, [2, 0]].T.astype(np.float32))


@pytest.mark.parametrize("n", [100, 8191, 8192, 8193, 20_000, 65_536])
def test_read_is_exact_after_wrapping(n):
    history = History(2, SIGNALS - 2, 8192)
    data = signal(n)
    feed(history, data, [512])
    assert history.first_tick == max(0, n - 8192)
    found = history.read([2, 0], 0, n + 50)
    np.testing.assert_array_equal(found, data[history.first_tick :, [2, 0]].T.astype(np.float32))
    assert history.read([1], n - 5, n - 2).shape == (1, 3)
    assert history.read([1], n + 5, n + 9).shape == (1, 0)
    assert history.read([1], 9, 3).shape == (1, 0)


def test_columns_outside_of_what_is_kept_are_empty():
    history = History(2, SIGNALS - 2, 8192)
    feed(history, signal(300), [100])
    found = history.columns([0], -100, 400, 5)
    assert np.all(np.isnan(found[0, :, 0])) and np.all(np.isnan(found[0, :, 4]))
    assert np.all(np.isfinite(found[0, :, 1:4]))
    assert np.all(np.isnan(History(2, SIGNALS - 2, 8192).columns([0, 1], 0, 100, 10)))


def test_more_columns_than_ticks_repeat_the_ticks():
    history = History(2, SIGNALS - 2, 8192)
    data = signal(100)
    feed(history, data, [7])
    found = history.columns([1], 10, 20, 40)
    expected = np.repeat(data[10:20, 1].astype(np.float32), 4)
    np.testing.assert_array_equal(found[0], [expected, expected])


def test_a_jump_in_time_starts_a_new_history():
    history = History(2, SIGNALS - 2, 8192)
    feed(history, signal(5000), [512])
    data = signal(3000, seed=4)
    feed(history, data, [100], first=1234)
    assert (history.first_tick, history.end_tick) == (1234, 4234)
    whole = np.vstack([np.zeros((1234, SIGNALS)), data])
    for columns in (1, 7, 100, 999):
        found = history.columns([0, 1, 2], 0, 5000, columns)
        np.testing.assert_array_equal(found, expected_columns(whole, range(1234, 4234), 0, 5000, columns))


def test_a_tap_that_was_idle_before_a_jump_is_written_after_it():
    """Each time it is idle for half of the ring, over the same half; the other half has samples from before."""
    history = History(2, SIGNALS - 2, 4096)
    half = history.capacity // 2
    data = signal(history.capacity + 2 * half)
    feed(history, data[: history.capacity], [512])
    data[history.capacity :, 2] = 0.0
    for first in (history.capacity, history.capacity, history.capacity + half):
        outputs, taps = np.split(data[first : first + half], [2], axis=1)
        history.append(Rows(first, half, outputs.copy(), taps.copy(), np.ones(SIGNALS - 2, dtype=np.bool_)))
    kept = range(history.first_tick, history.end_tick)
    assert len(kept) == half and kept.stop == len(data)
    np.testing.assert_array_equal(history.read([0, 1, 2], 0, len(data)), data[kept.start :].T.astype(np.float32))
    found = history.columns([0, 1, 2], kept.start, kept.stop, 70)
    np.testing.assert_array_equal(found, expected_columns(data, kept, kept.start, kept.stop, 70))


def last_crossing(x: np.ndarray, rising: bool, level: float, hysteresis: float, start: int, stop: int) -> int | None:
    """Crossings of a Schmitt trigger: armed beyond the band, fires at the level."""
    y = (x.astype(np.float32).astype(float) - level) * (1 if rising else -1)
    armed, found = False, None
    for i in range(start, stop):
        if y[i] < -hysteresis:
            armed = True
        elif y[i] >= 0 and armed:
            found, armed = i, False
    return found


@given(
    level=st.floats(-60, 60),
    hysteresis=st.one_of(st.just(0.0), st.floats(0, 20)),
    rising=st.booleans(),
    ends=st.tuples(st.integers(0, 11_000), st.integers(0, 11_000)),
)
def test_crossing_against_plain_arrays(level, hysteresis, rising, ends):
    history = History(2, SIGNALS - 2, 8192)
    data = signal(10_000, seed=2)
    feed(history, data, [512])
    start, stop = min(ends), max(ends)
    found = history.crossing(1, "rising" if rising else "falling", level, hysteresis, start, stop)
    kept = max(start, history.first_tick), min(stop, 10_000)
    assert found == last_crossing(data[:, 1], rising, level, hysteresis, *kept)


def test_hysteresis_ignores_noise_around_the_level():
    t = np.arange(4000)
    x = np.sin(2 * np.pi * t / 400) + 0.05 * np.random.default_rng(1).normal(size=4000)
    history = History(2, SIGNALS - 2, 8192)
    feed(history, np.column_stack([x, x, x]), [512])

    def crossings(hysteresis: float) -> list[int]:
        found, stop = [], 4000
        while (at := history.crossing(0, "rising", 0.0, hysteresis, 0, stop)) is not None:
            found.append(at)
            stop = at
        return found

    assert len(crossings(0.3)) == 10  # each of ten periods once, the last of them at its very end
    assert len(crossings(0.0)) > 15


def test_history_of_a_board_holds_its_signals_at_full_rate():
    board = make({}, base=RICH)
    history = History(board.signals.outputs, len(board.signals.taps), 8192)
    kept = []
    for n in (3, 512, 100):
        rows = board.advance(n)
        kept.append(np.hstack([rows.outputs, rows.taps]))
        history.append(rows)
    whole = np.vstack(kept).astype(np.float32)
    np.testing.assert_array_equal(history.read(list(range(len(board.signals))), 0, 615), whole.T)
    assert history.nbytes > 4096 * len(board.signals) * 4
