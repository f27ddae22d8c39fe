"""How often pictures are sent, against a loop that works for a known share of its time."""

from __future__ import annotations

import pytest

from server.stream.hub import BUSY, SLOWEST_S, Pace


def settled(picture_s: float, other: float, rate_hz: float = 60.0) -> float:
    """Let pictures cost time each, and other work a share of all time; return the period they come to."""
    worked = now = 0.0
    pace = Pace(rate_hz, lambda: worked)
    while now < 60.0:
        assert pace.is_due(now)
        pace.begin(now)
        assert not pace.is_due(now) and pace.is_due(now + pace.wait_s(now))
        assert pace.wait_s(now) == pytest.approx(pace.period_s)
        assert pace.wait_s(now + pace.period_s) == pytest.approx(0.0, abs=1e-9)
        worked += picture_s + other * pace.period_s
        now += pace.period_s
    return pace.period_s


def test_a_loop_with_time_keeps_the_rate_asked_for() -> None:
    assert settled(0.005, 0.1) == pytest.approx(1 / 60)


@pytest.mark.parametrize(("picture_s", "other"), [(0.02, 0.0), (0.02, 0.2), (0.05, 0.1)])
def test_a_busy_loop_is_busy_for_the_share_it_may(picture_s: float, other: float) -> None:
    """Work in a period T: cost + other T = BUSY T."""
    assert settled(picture_s, other) == pytest.approx(picture_s / (BUSY - other), rel=0.02)


def test_pictures_never_stop() -> None:
    assert settled(0.01, 0.9) == SLOWEST_S
