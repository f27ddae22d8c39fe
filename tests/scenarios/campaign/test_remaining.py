"""What is still to be made: handed out once, taken back when it is lost, and small."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np

from scenarios.campaign.points import Contents
from scenarios.campaign.remaining import Remaining
from scenarios.campaign.sweep import Sweep

SEVEN: dict[str, Any] = {"schema": 1, "scenario": "ch5-seven-step", "set": {"samples": 50}}


def nothing(_: Sequence[str]) -> set[str]:
    return set()


def test_runs_are_handed_out_in_order_once_and_again_when_they_are_lost() -> None:
    sweep = Sweep({**SEVEN, "seeds": {"count": 4}, "grid": {"sensor.noise_um": [0.1, 0.2]}})
    keys = [key for key, _, _ in sweep.runs()]
    remaining = Remaining(sweep, lambda some: {keys[1], keys[6], "of another"} & {*some, "of another"})
    assert (remaining.total, len(remaining), remaining.waiting) == (8, 6, 6)
    first = remaining.take(3)
    assert [key for key, _, _ in first] == [keys[0], keys[2], keys[3]]
    assert [(point.labels["sensor.noise_um"], seed) for _, point, seed in first] == [(0.1, 1), (0.1, 3), (0.1, 4)]
    assert len({id(point) for _, point, _ in first}) == 1, "runs of a point share it, and the worker reads it once"
    remaining.finish(keys[2])
    remaining.finish("nobody's")
    assert (len(remaining), remaining.waiting) == (5, 3)
    remaining.take_back()
    assert [key for key, _, _ in remaining.take(99)] == [keys[n] for n in (0, 3, 4, 5, 7)]
    assert remaining.take(1) == [] and remaining.waiting == 0
    for key in keys:
        remaining.finish(key)
    assert not remaining


def test_points_of_one_content_count_once() -> None:
    variants = [
        {"name": name, "set": {"sensor.noise_um": noise}} for name, noise in (("a", 0.1), ("b", 0.2), ("c", 0.1))
    ]
    remaining = Remaining(Sweep({**SEVEN, "seeds": {"count": 3}, "variants": variants}), nothing)
    assert remaining.total == len(remaining) == 6
    assert [point.labels["variant"] for _, point, _ in remaining.take(9)] == ["a"] * 3 + ["b"] * 3


def test_a_million_runs_take_a_byte_each() -> None:
    sweep = Sweep({**SEVEN, "seeds": {"count": 1_000_000}})
    sweep.key = lambda number: str(number)  # type: ignore[method-assign]
    remaining = Remaining(sweep, nothing)
    assert remaining.total == 1_000_000
    state = next(value for value in vars(remaining).values() if isinstance(value, np.ndarray))
    others = sum(sys.getsizeof(value) for value in vars(remaining).values() if value is not state)
    assert state.nbytes == 1_000_000 and others < 1000


def test_points_are_made_when_they_are_asked_for() -> None:
    hypercube = {"points": 100_000, "ranges": {"sensor.noise_um": {"min": 0.01, "max": 0.2}}}
    sweep = Sweep({**SEVEN, "latin_hypercube": hypercube, "variants": [{"name": "a", "set": {}}]})
    assert len(sweep.points) == len(sweep) == 100_000
    last = sweep.points[99_999]
    assert last.labels == {"variant": "a", "sensor.noise_um": last.values["sensor.noise_um"]}
    assert [point.labels for point in sweep.points[99_998:]][1] == last.labels
    assert isinstance(sweep.contents, Contents) and sweep.key(99_999) == sweep.key(99_999) != sweep.key(0)
    assert sum(bool(known) for known in sweep.contents._known) == 2, "two hashes were worked out"
