"""A row of the speed table tells its median and spread, and is held against its target."""

from __future__ import annotations

import pytest

from scenarios.speed.figure import figure, per_sample, ratio, scaled


@pytest.mark.parametrize(
    ("target", "words", "ok"),
    [
        ({}, "information", True),
        ({"least": 2.0}, ">= 2", True),
        ({"least": 2.1}, ">= 2.1", False),
        ({"most": 2.0}, "<= 2", True),
        ({"most": 1.9}, "<= 1.9", False),
    ],
)
def test_the_median_is_held_against_the_target(target, words, ok):
    row = figure("x", [9.0, 2.0, 1.0], "us", **target)
    assert row == {
        "name": "x",
        "value": 2.0,
        "low": 1.0,
        "high": 9.0,
        "repeats": 3,
        "unit": "us",
        "target": words,
        "ok": ok,
    }


def test_ratios_are_taken_within_a_repeat():
    costs = {"slow": [100.0, 300.0], "fast": [10.0, 10.0]}
    assert ratio(costs, "slow", "fast") == [10.0, 30.0]
    assert scaled(costs, "slow", 1e-3) == [0.1, 0.3]
    assert per_sample(costs, "fast", 1e4) == [1000.0, 1000.0]
