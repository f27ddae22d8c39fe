"""Pacing: exact targets without drift, bounded catch-up, honest figures."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.bench.pacing import CATCH_UP_S, Pacer

DT_S = 1e-5


@given(st.floats(1e-6, 1.0), st.lists(st.floats(1e-4, 0.02), min_size=1, max_size=200))
def test_targets_do_not_drift(scale: float, pauses: list[float]) -> None:
    """After any sequence of rounds the target equals the target of one step."""
    pacer, now, tick = Pacer(DT_S, scale), 100.0, 0
    pacer.anchor(0, now)
    for pause in pauses:
        now += pause
        target = pacer.target(tick, now)
        assert target is not None and target >= tick
        tick = target
        pacer.record(tick, target, now)
    assert tick == int((now - 100.0) * (scale / DT_S))
    assert pacer.given_up_s == 0.0 and pacer.overruns == 0 and not pacer.capped


def test_a_long_stall_is_given_up_and_counted() -> None:
    pacer = Pacer(DT_S, 1.0)
    pacer.anchor(0, 0.0)
    target = pacer.target(0, 1.0)
    assert target == pytest.approx(CATCH_UP_S / DT_S, abs=1)
    assert target is not None
    assert pacer.given_up_s == pytest.approx(1.0 - CATCH_UP_S, abs=2 * DT_S)
    pacer.record(target, target, 1.0)
    assert not pacer.capped  # a single stall is over before a page can show it
    # From here on it runs at its rate again.
    assert pacer.target(target, 1.01) == pytest.approx(target + 1000, abs=1)


def test_a_bench_that_cannot_keep_up_is_capped_and_says_so() -> None:
    pacer, tick, since = Pacer(DT_S, 1.0), 0, math.inf
    pacer.anchor(0, 0.0)
    for round_number in range(1, 500):
        now = round_number / 120
        target = pacer.target(tick, now)
        assert target is not None
        tick = min(target, tick + 400)  # half of what real time needs
        pacer.record(tick, target, now)
        if pacer.capped:
            since = min(since, now)
    assert pacer.capped
    assert 3.0 <= since < 3.2
    assert pacer.achieved == pytest.approx(400 * 120 * DT_S, rel=0.02)
    assert pacer.overruns > 300
    for round_number in range(500, 800):  # it can again
        tick = pacer.target(tick, round_number / 120) or tick
        pacer.record(tick, tick, round_number / 120)
    assert not pacer.capped


def test_a_little_behind_is_not_capped() -> None:
    pacer, tick = Pacer(DT_S, 1.0), 0
    pacer.anchor(0, 0.0)
    for round_number in range(1, 1200):
        target = pacer.target(tick, round_number / 120)
        assert target is not None
        tick = min(target, tick + 700)  # 84 % of what real time needs
        pacer.record(tick, target, round_number / 120)
        assert not pacer.capped
    assert pacer.given_up_s > 1.0


def test_less_than_a_tick_per_second_is_not_capped() -> None:
    pacer, tick = Pacer(DT_S, 1e-6), 0
    pacer.anchor(0, 0.0)
    for round_number in range(1, 3600):
        now = round_number / 120
        tick = pacer.target(tick, now) or tick
        pacer.record(tick, tick, now)
        assert not pacer.capped
    assert tick == 2
    assert pacer.achieved == 1e-6


def test_a_change_of_scale_counts_from_there() -> None:
    pacer = Pacer(DT_S, 1e-3)
    pacer.anchor(0, 0.0)
    assert pacer.target(0, 0.01) == 1
    pacer.rescale(0.1, 1, 0.01, is_running=True)
    assert pacer.target(1, 0.02) == pytest.approx(101, abs=1)
    pacer.rescale(None, 101, 0.02, is_running=True)
    assert pacer.target(101, 0.03) is None
    pacer.rescale(0.1, 101, 50.0, is_running=False)
    assert pacer.target(101, 50.0) == 101 and pacer.given_up_s == 0.0


def test_changes_of_scale_lose_no_time() -> None:
    """Forty a second, each in the middle of a round: ticks that were due before stay due."""
    pacer, tick, now = Pacer(DT_S, 1.0), 0, 0.0
    pacer.anchor(0, 0.0)
    for number in range(400):
        now += 0.025
        pacer.rescale(1.0 if number % 2 else 0.5, tick, now - 0.004, is_running=True)
        tick = pacer.target(tick, now) or tick
        pacer.record(tick, tick, now)
    assert tick * DT_S == pytest.approx(0.75 * now, rel=2e-3)


def test_without_a_limit_the_rate_is_measured_on_the_clock() -> None:
    pacer = Pacer(DT_S, None)
    pacer.anchor(0, 0.0)
    for round_number in range(1, 121):
        pacer.record(round_number * 20_000, None, round_number / 120)
    assert pacer.achieved == pytest.approx(20_000 * 120 * DT_S)
    assert not pacer.capped
