"""A faulty document is refused before a campaign begins; random draws are left to its runs."""

from __future__ import annotations

from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest

from core.errors import InputError
from scenarios.campaign import check as module
from scenarios.campaign.check import check
from scenarios.campaign.points import Points, RowsAxis
from scenarios.campaign.sweep import Sweep
from scenarios.schema import Scenario

NOISE = "sensor.noise_um"
SEVEN: dict[str, Any] = {"schema": 1, "scenario": "ch5-seven-step", "set": {"samples": 50}}


def cube(points: int, **ranges: tuple[float, float]) -> dict[str, Any]:
    named = {name.replace("__", "."): {"min": low, "max": high} for name, (low, high) in ranges.items()}
    return {"latin_hypercube": {"points": points, "ranges": named}}


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"grid": {NOISE: [0.1, 0.2, -1.0, 0.3]}}, NOISE),
        ({"grid": {NOISE: [0.001 * number for number in range(1, 1500)] + [-1.0]}}, NOISE),
        ({"grid": {NOISE: [0.1], "controller.kind": ["mrac", "mrak"]}}, "controller.kind"),
        ({"variants": [{"name": "a", "set": {}}, {"name": "b", "set": {"sensor.nose_um": 1.0}}]}, "nose_um"),
        (cube(10_000, sensor__nose_um=(0.1, 0.2)), "nose_um"),
        (cube(10_000, sensor__noise_um=(-0.5, 0.2)), NOISE),
        (cube(10_000, sensor__noise_um=(0.1, 0.2), samples=(-1000.0, 10.0)), "samples"),
    ],
)
def test_a_slip_in_one_value_of_many_is_refused(change: dict[str, Any], field: str) -> None:
    with pytest.raises(InputError) as caught:
        check(Sweep({**SEVEN, **change}))
    assert field in str(caught.value)


def test_few_of_many_points_are_read(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[int] = []
    load = Scenario.load
    monkeypatch.setattr(module.Scenario, "load", lambda *a, **named: (read.append(1), load(*a, **named))[1])
    check(Sweep({**SEVEN, **cube(20_000, sensor__noise_um=(0.1, 0.2)), "grid": {"controller.kind": ["pid", "mrac"]}}))
    assert 4 <= len(read) <= 8


def test_of_what_chance_draws_one_that_is_possible_is_enough() -> None:
    """A first device that is impossible is passed over; where all are, the campaign is refused."""
    sweep = Sweep(SEVEN)
    for noises, is_possible in (([-1.0, 0.1, -2.0], True), ([-1.0, -2.0], False)):
        sweep.points = Points([RowsAxis({NOISE: np.array(noises)}, "device")], sweep.base.document)
        with nullcontext() if is_possible else pytest.raises(InputError, match=NOISE):
            check(sweep)


@pytest.mark.parametrize(
    ("change", "samples"),
    [
        ({}, 50),
        ({"grid": {"samples": [20, 70, 30]}}, 70),
        ({"set": {}, "scenario": "first-look", "grid": {"duration_ms": [1.0, 3.0], "sample_rate_khz": [50, 80]}}, 240),
        ({"variants": [{"name": "a", "set": {}}, {"name": "b", "set": {"samples": 60}}]}, 60),
    ],
)
def test_the_longest_is_found_among_all_points(change: dict[str, Any], samples: int) -> None:
    assert check(Sweep({**SEVEN, **change})).samples == samples
