"""Captures: their content, the order of their removal, and the limit of their cost."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.board.history import History
from core.board.rows import Rows
from server.bench import captures as module
from server.bench.captures import AT_ONCE, MOST, MOST_SETS, Captured, Captures, CaptureSet
from server.bench.journal import Branches
from server.stream.view import PictureCutter
from server.stream.wire import Subscribe, TriggerSpec

DT = 0.01
WINDOW, BEFORE = 60, 15


def wave(ticks: Any) -> Any:
    """A square of period 100 with a slope of its own at every tick, so that no two ticks are alike."""
    ticks = np.asarray(ticks)
    return np.where(ticks % 100 < 50, -1.0, 1.0) + ticks * 1e-7


class Bench:
    """A bench of two signals, the second the negative of the first; its views look at it as pages do."""

    def __init__(self, capacity: int = 4096, most_bytes: int = 10**6) -> None:
        self.history, self.branches = History(1, 1, capacity), Branches()
        self.captures = Captures(self, most_bytes)

    def run(self, ticks: int, sign: float = 1.0) -> None:
        part = sign * wave(np.arange(self.history.end_tick, self.history.end_tick + ticks))[:, None]
        self.history.append(Rows.of(self.history.end_tick, np.hstack([part, -part]), 1))

    def go_back(self, tick: int) -> None:
        self.history.end_tick = tick
        self.branches.begin(self.branches.current, tick)

    # what views ask of a bench

    @property
    def first_tick(self) -> int:
        return self.history.first_tick

    @property
    def end_tick(self) -> int:
        return self.history.end_tick

    def read(self, *args: Any) -> Any:
        return self.history.read(*args)

    def columns(self, signals: list[int], start: int, stop: int, columns: int) -> Any:
        found = self.history.columns(signals, start, stop, columns)
        self.captures.fold(found, signals, start, stop)
        return found

    def capture(self, kept: CaptureSet, tick: int, at: float) -> None:
        self.captures.found(kept, tick, at)

    def look(self, *views: PictureCutter) -> None:
        self.captures.follow()
        for view in views:
            view.picture(self)
        self.captures.gather()


def opened(
    bench: Bench, level: float = 0.0, window: int = WINDOW, signals: tuple[str, ...] = ("a", "b"), **trigger: Any
):  # type: ignore[no-untyped-def]
    """Open a triggered view; return it and its captures."""
    spec = TriggerSpec(signal="a", level=level, position=BEFORE / WINDOW, **trigger)
    ask = Subscribe(
        type="subscribe",
        panel=1,
        signals=list(signals),
        mode="triggered",
        trigger=spec,
        window_ms=window * DT,
        width=50,
    )
    columns = [("a", "b").index(name) for name in signals]
    before = round(window * BEFORE / WINDOW)
    what = Captured(signals, "a", spec.edge, level, spec.upper, spec.hysteresis, window, before)
    kept = bench.captures.open(what, columns)
    return PictureCutter(ask, columns, 0, DT, bench.end_tick, captures=kept), kept


def ticks_of(kept: CaptureSet) -> list[int]:
    return [one.crossing.tick for one in kept.captures]


def test_a_capture_has_every_sample_around_its_crossing() -> None:
    bench = Bench()
    view, kept = opened(bench)
    for _ in range(10):
        bench.run(37)
        bench.look(view)
    # the square rises at 50, 150, 250; the window of the last is complete at 295
    assert ticks_of(kept) == [50, 150, 250]
    for one in kept.captures:
        expected = np.float32(wave(np.arange(one.crossing.tick - BEFORE, one.crossing.tick - BEFORE + WINDOW)))
        assert one.start == one.crossing.tick - BEFORE
        np.testing.assert_array_equal(one.samples, [expected, -expected])
        # from -1 to 1 within a tick, so it crosses 0 in the middle of it
        assert one.crossing.at == pytest.approx(one.crossing.tick - 0.5, abs=1e-3)


def test_the_51st_drops_the_first_and_all_outlive_the_history() -> None:
    bench = Bench()
    view, kept = opened(bench)
    for _ in range(3000):
        bench.run(10)
        bench.look(view)
    assert bench.first_tick > 20_000
    rises = list(range(50, 30_000, 100))
    assert MOST == 50 and ticks_of(kept) == rises[-MOST:]
    bench.run(6000)
    oldest = kept.captures[0]
    assert oldest.stop < bench.first_tick
    found = bench.columns([1, 0], oldest.start, oldest.stop, WINDOW)
    expected = np.float32(wave(np.arange(oldest.start, oldest.stop)))
    np.testing.assert_array_equal(found, [[-expected, -expected], [expected, expected]])
    covered = bench.captures.covering([1], oldest.start + 3, oldest.stop - 4)
    np.testing.assert_array_equal(covered, [-expected[3:-4]])
    assert bench.captures.covering([1], oldest.start, oldest.stop + 1) is None


@pytest.mark.parametrize("step", [4000, 4096, 10_000])
def test_a_long_step_between_two_looks_loses_no_capture_that_the_history_still_has(step: int) -> None:
    bench = Bench()
    view, kept = opened(bench)
    for _ in range(4):
        bench.run(step)
        bench.look(view)
        head = bench.end_tick
        whole = [at for at in range(50, head, 100) if at - BEFORE >= bench.first_tick and at - BEFORE + WINDOW <= head]
        assert ticks_of(kept)[-len(whole) :] == whole


def test_columns_join_captures_and_history_and_leave_gaps() -> None:
    bench = Bench()
    view, kept = opened(bench)
    bench.run(3000)
    bench.look(view)
    bench.run(4200)
    first = bench.first_tick
    start, stop = first - 500, first + 124
    found = bench.columns([0], start, stop, 312)
    told = np.zeros(stop - start, bool)
    told[first - start :] = True
    for one in kept.captures:
        told[max(one.start - start, 0) : max(one.stop - start, 0)] = True
    assert told[:500].any() and not told[:500].all()
    values = np.where(told, np.float32(wave(np.arange(start, stop))), np.nan).astype(np.float32).reshape(-1, 2)
    np.testing.assert_array_equal(found[0, 0], np.fmin(values[:, 0], values[:, 1]))
    np.testing.assert_array_equal(found[0, 1], np.fmax(values[:, 0], values[:, 1]))


def test_what_comes_before_the_first_tick_is_left_out_and_captures_do_not_overlap() -> None:
    bench = Bench()
    view, kept = opened(bench, window=240)
    bench.run(1000)
    bench.look(view)
    # 50 - 60 is before tick 0; the next windows begin at 190, 490 and 790 at the earliest
    assert [(one.crossing.tick, one.start, one.stop) for one in kept.captures] == [
        (50, 0, 230),
        (350, 290, 530),
        (650, 590, 830),
    ]


def test_a_bench_that_goes_back_drops_what_is_ahead_of_it_although_it_has_come_as_far_again() -> None:
    bench = Bench()
    view, kept = opened(bench)
    bench.run(1000)
    bench.look(view)
    assert ticks_of(kept)[-1] == 950
    bench.go_back(430)
    bench.run(570, sign=-1.0)
    bench.captures.follow()
    assert ticks_of(kept) == [50, 150, 250, 350]
    bench.run(400, sign=-1.0)
    bench.look(view)
    for one in kept.captures[4:]:
        assert one.crossing.tick % 100 == 0 and one.crossing.tick >= 1000
        np.testing.assert_array_equal(one.samples[0], np.float32(-wave(np.arange(one.start, one.stop))))
    assert len(kept.captures) > 4


def test_a_copy_under_way_is_given_up_when_the_bench_goes_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "AT_ONCE", 40)
    bench = Bench()
    view, kept = opened(bench)
    bench.run(1000)
    bench.look(view)
    assert kept.coming is not None and not kept.captures
    bench.go_back(20)
    bench.run(1500, sign=-1.0)
    bench.captures.gather()
    assert kept.coming is None and not kept.captures and not kept.waiting


def test_copying_takes_turns_and_no_look_copies_more_than_its_share() -> None:
    bench = Bench(200_000, most_bytes=10**7)
    views = [opened(bench, level=0.1 * number, window=6000) for number in range(3)]
    bench.run(100_000)
    read: list[int] = []
    history_read = bench.history.read
    bench.history.read = lambda signals, *span: read.append(0) or _counted(history_read(signals, *span), read)  # type: ignore[method-assign,func-returns-value]
    bench.captures.follow()
    for view, _ in views:
        view.picture(bench)
    seen = []
    while any(kept.waiting or kept.coming for _, kept in views):
        read.clear()
        bench.captures.gather()
        assert sum(read) <= AT_ONCE + 2
        seen.append([len(kept.captures) for _, kept in views])
    assert len(seen) > 3
    # none waits until another has all of its own
    assert all(count > 0 for count in next(counts for counts in seen if max(counts) >= 10))


def _counted(samples: Any, read: list[int]) -> Any:
    read[-1] = samples.size
    return samples


def test_memory_is_bounded_and_the_trigger_with_the_most_gives_its_oldest() -> None:
    one_capture = 2 * 4 * WINDOW
    bench = Bench(most_bytes=30 * one_capture)
    (first, kept), (second, others) = opened(bench), opened(bench, level=-0.5)
    bench.run(2001)
    bench.look(first)
    assert len(kept.captures) == 20 and not kept.is_short
    for _ in range(40):
        bench.run(100)
        bench.look(first, second)
        assert sum(one.samples.nbytes for both in (kept, others) for one in both.captures) <= 30 * one_capture
    assert (len(kept.captures), len(others.captures)) == (15, 15)
    assert kept.is_short and others.is_short
    assert ticks_of(kept) == list(range(4550, 6000, 100))


def test_a_window_larger_than_the_memory_is_not_kept_and_says_so() -> None:
    bench = Bench(most_bytes=4 * 2 * WINDOW - 1)
    view, kept = opened(bench)
    bench.run(500)
    bench.look(view)
    assert not kept.captures and not kept.waiting and kept.is_short and kept.edition > 0


def test_a_bench_keeps_so_many_triggers_and_never_drops_one_that_is_shown() -> None:
    bench = Bench()
    bench.run(1000)
    views = [opened(bench, level=0.01 * number) for number in range(MOST_SETS)]
    bench.look(*(view for view, _ in views))
    assert opened(bench, level=0.9)[1] is None
    assert all(kept.captures for _, kept in views)
    del views[3]
    views.append(opened(bench, level=0.9))
    assert views[-1][1] is not None and opened(bench, level=0.01 * 3)[1] is None
    # a second page with the same subscription, and a page that comes back, see the same
    assert opened(bench, level=0.02)[1] is views[2][1]


def test_window_hysteresis_and_single_capture_what_they_trigger_on() -> None:
    bench = Bench()
    bench.run(250)
    _, kept = single = opened(bench, sweep="single")
    leaves = opened(bench, level=-1.5, edge="leaves", upper=0.0)
    enters = opened(bench, level=-1.5, edge="enters", upper=0.0)
    far = opened(bench, hysteresis=1.5)
    bench.run(300)
    bench.look(*(view for view, _ in (single, leaves, enters, far)))
    assert ticks_of(kept) == [350]
    assert ticks_of(leaves[1]) == [50, 150, 250, 350, 450]
    assert ticks_of(enters[1]) == [100, 200, 300, 400, 500]
    assert ticks_of(far[1]) == []  # it goes back by 1
    # in another sweep the same trigger has the same captures, and the additional windows of the history
    auto, same = opened(bench)
    assert same is kept
    bench.run(200)
    bench.look(auto)
    assert ticks_of(kept) == [350, 450, 550, 650]
    single[0].rearm(bench.end_tick)
    bench.run(600)
    bench.look(single[0])
    assert ticks_of(kept) == [350, 450, 550, 650, 850]


def test_a_frozen_view_of_a_scope_looks_at_its_captures_and_adds_none() -> None:
    bench = Bench()
    view, kept = opened(bench)
    bench.run(300)
    bench.look(view)
    frozen = Subscribe(
        type="subscribe", panel=1, signals=["a", "b"], mode="frozen", start_tick=35, end_tick=95, width=60,
        trigger=view.spec.trigger, window_ms=WINDOW * DT,
    )  # fmt: skip
    standing = PictureCutter(frozen, [0, 1], 0, DT, bench.end_tick, captures=kept)
    bench.run(9000)
    bench.look(standing)
    assert ticks_of(kept) == [50, 150, 250]
    np.testing.assert_array_equal(standing.picture(bench).columns[0, 1], np.float32(wave(np.arange(35, 95))))
