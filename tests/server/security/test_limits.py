"""Token buckets."""

from __future__ import annotations

from server.security.limits import Bucket, Buckets


def test_a_burst_is_taken_at_once_and_the_rate_after_it() -> None:
    now = [0.0]
    bucket = Bucket(20.0, 40, lambda: now[0])
    assert [bucket.take() for _ in range(41)] == [True] * 40 + [False]
    now[0] = 1.0
    assert sum(bucket.take() for _ in range(100)) == 20
    now[0] = 100.0
    assert sum(bucket.take() for _ in range(100)) == 40


def test_callers_do_not_take_from_each_other_and_are_not_remembered_for_ever() -> None:
    buckets = Buckets(0.0001, 1, most=2)
    assert buckets.take("a") and not buckets.take("a")
    assert buckets.take("b")
    assert not buckets.take("a")
    assert buckets.take("c")  # pushes out b, unused the longest
    assert buckets.take("b")
