"""Pictures of a panel: the right span, the right extremes, sent only when they change."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.board.history import History
from core.board.rows import Rows
from server.stream.codec import FROZEN, TRIGGERED, WAITING, Picture
from server.stream.panel import Panel
from server.stream.view import PictureCutter, TickSpan
from server.stream.wire import Subscribe, TriggerSpec

DT = 0.01


def fill(history: History, values: np.ndarray[Any, Any]) -> None:
    """Append a signal (and its negative as a tap) after the existing samples."""
    for start in range(0, len(values), 100):
        part = np.ascontiguousarray(values[start : start + 100, None], np.float64)
        history.append(Rows.of(history.end_tick, np.hstack([part, -part]), part.shape[1]))


class Cuts:
    """A history at its present moment, as a bench's cuts have it."""

    def __init__(self, history: History) -> None:
        self._history = history

    def picture(self, view: PictureCutter) -> Picture:
        return view.picture(self._history)


def picture_of(one: Panel, history: History) -> Picture | None:
    return one.picture(Cuts(history))  # type: ignore[arg-type]


def panel(head: int = 0, **fields: Any) -> Panel:
    spec = Subscribe(**{"type": "subscribe", "panel": 1, "signals": ["a"], "window_ms": 1.0, **fields})
    return Panel(PictureCutter(spec, [0], 0 if spec.trigger else None, DT, head), 1)


@given(st.integers(0, 10**6), st.integers(2, 10**5), st.integers(1, 4096))
def test_a_rolling_span_covers_its_window_in_whole_columns(head: int, window: int, width: int) -> None:
    span = TickSpan.ending(head, window, width)
    step = (span.end - span.start) // span.columns
    assert span.start + step * span.columns == span.end
    assert span.start % step == 0
    assert head <= span.end < head + step
    assert span.columns <= width
    assert span.end - span.start >= window


@given(st.integers(-1000, 10**6), st.integers(1, 10**5), st.integers(1, 4096))
def test_a_frozen_span_covers_what_was_asked(start: int, length: int, width: int) -> None:
    span = TickSpan.between(start, start + length, width)
    step = (span.end - span.start) // span.columns
    assert span.start <= start < span.start + step
    assert start + length <= span.end
    assert span.columns <= width + 1


def test_a_rolling_picture_keeps_its_columns_while_it_moves() -> None:
    history = History(1, 1, 20_000)
    rng = np.random.default_rng(1)
    fill(history, rng.normal(size=1003))
    rolling = panel(window_ms=8.0, width=100)
    first = picture_of(rolling, history)
    fill(history, rng.normal(size=9))
    second = picture_of(rolling, history)
    assert first is not None and second is not None
    step = (first.end - first.start) / first.columns.shape[2]
    moved = round((second.start - first.start) / step)
    assert (second.start - first.start) % step == 0
    # All columns that were complete in both pictures are the same.
    np.testing.assert_array_equal(first.columns[:, :, moved:-1], second.columns[:, :, : -1 - moved])


def test_a_spike_of_one_tick_is_never_lost() -> None:
    history = History(1, 1, 200_000)
    values = np.zeros(100_000)
    values[77_777] = 5.0
    fill(history, values)
    picture = picture_of(panel(window_ms=1000.0, width=100), history)
    assert picture is not None
    assert np.nanmax(picture.columns[0, 1]) == 5.0


def test_the_same_picture_is_not_sent_twice() -> None:
    history = History(1, 1, 20_000)
    fill(history, np.zeros(50))
    for kind in ({"mode": "roll"}, {"mode": "frozen", "start_tick": 0, "end_tick": 40}):
        one = panel(**kind)
        assert picture_of(one, history) is not None
        assert picture_of(one, history) is None


def test_a_frozen_picture_follows_until_its_end_is_reached() -> None:
    history = History(1, 1, 20_000)
    fill(history, np.zeros(50))
    frozen = panel(mode="frozen", start_tick=20, end_tick=80, width=60)
    first = picture_of(frozen, history)
    assert first is not None and first.flags == FROZEN
    assert np.isnan(first.columns[0, 0]).sum() == 30
    fill(history, np.ones(50))
    second = picture_of(frozen, history)
    assert second is not None and not np.isnan(second.columns).any()
    fill(history, np.ones(50))
    assert picture_of(frozen, history) is None


def test_a_bench_that_goes_back_in_time_is_shown_again() -> None:
    history = History(1, 1, 20_000)
    fill(history, sine(1000))
    auto, rolling = triggered("auto", head=1000), panel()
    assert picture_of(auto, history) and picture_of(rolling, history)
    history.end_tick = 300
    fill(history, sine(310)[300:])
    for one in (auto, rolling):
        again = picture_of(one, history)
        assert again is not None and again.end <= 310
    fill(history, sine(500)[310:])
    later = picture_of(auto, history)
    assert later is not None and later.flags == TRIGGERED and 310 < later.trigger < 500


def sine(ticks: int, period: float = 40.0) -> np.ndarray[Any, Any]:
    return np.sin(2 * np.pi * (np.arange(ticks) - 0.5) / period)


def triggered(sweep: str, **fields: Any) -> Panel:
    spec = TriggerSpec(signal="a", level=0.0, hysteresis=0.05, position=0.25, sweep=sweep)  # type: ignore[arg-type]
    return panel(mode="triggered", trigger=spec, window_ms=0.6, width=200, **fields)


def test_a_triggered_picture_stands_still_at_any_moment() -> None:
    history = History(1, 1, 20_000)
    fill(history, sine(500))
    auto = triggered("auto", head=500)
    seen = []
    for piece in (7, 33, 80, 1, 1, 1, 200):
        data = sine(history.end_tick + piece)[history.end_tick :]
        fill(history, data)
        picture = picture_of(auto, history)
        if picture is None:
            continue
        assert picture.flags == TRIGGERED
        assert picture.end <= history.end_tick
        assert picture.start + 15 == pytest.approx(picture.trigger, abs=1.0)
        # The crossing of this sine is half a tick behind a multiple of its period.
        seen.append((picture.trigger - 0.5) % 40)
    assert len(seen) >= 4
    np.testing.assert_allclose((np.array(seen) + 20) % 40 - 20, 0.0, atol=2e-3)


def test_normal_waits_and_auto_rolls_when_nothing_triggers() -> None:
    history = History(1, 1, 20_000)
    fill(history, np.ones(500))
    waiting, rolling = picture_of(triggered("normal"), history), picture_of(triggered("auto"), history)
    assert waiting is not None and waiting.flags == WAITING and np.isnan(waiting.columns).all()
    assert rolling is not None and rolling.flags == WAITING and not np.isnan(rolling.columns).all()


def test_normal_keeps_the_last_picture_and_single_the_first() -> None:
    history = History(1, 1, 20_000)
    fill(history, np.zeros(100) - 1)
    normal, single = triggered("normal", head=100), triggered("single", head=100)
    fill(history, sine(200))
    shown = picture_of(normal, history)
    assert shown is not None and shown.flags == TRIGGERED and shown.trigger > 200
    first = picture_of(single, history)
    assert first is not None and first.flags == TRIGGERED
    assert first.trigger == pytest.approx(100.5, abs=0.6)
    fill(history, sine(400))
    assert picture_of(single, history) is None
    single.view.rearm(history.end_tick)
    armed = picture_of(single, history)
    assert armed is not None and armed.flags == TRIGGERED | WAITING
    assert armed.trigger == first.trigger
    fill(history, sine(200))
    again = picture_of(single, history)
    assert again is not None and again.flags == TRIGGERED and again.trigger > 700
    fill(history, np.ones(400))
    late = picture_of(normal, history)
    assert late is not None and late.flags & WAITING and not np.isnan(late.columns).all()


def test_pages_that_show_the_same_share_one_picture() -> None:
    history = History(1, 1, 20_000)
    fill(history, sine(500))
    spec = Subscribe(type="subscribe", panel=1, signals=["a"], window_ms=1.0)
    view = PictureCutter(spec, [0], None, DT, 0)
    first, second = Panel(view, 1), Panel(view, 3)
    shown = picture_of(first, history)
    assert shown is not None and picture_of(second, history) is shown
    assert picture_of(first, history) is None
    fill(history, sine(510)[500:])
    again = picture_of(second, history)
    assert again is not None and again is not shown
    view.forget()
    other = picture_of(second, history)
    assert other is not None and other is not again
    np.testing.assert_array_equal(other.columns, again.columns)
