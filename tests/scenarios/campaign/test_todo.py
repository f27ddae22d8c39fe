"""The remaining runs: handed out once, taken back when they are lost, and small."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from scenarios.campaign import points
from scenarios.campaign.points import Contents
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.todo import MOST_AT_ONCE, Remaining

SEVEN: dict[str, Any] = {"schema": 1, "scenario": "ch5-seven-step", "set": {"samples": 50}}


def nothing(_: Sequence[str]) -> set[str]:
    return set()


def test_runs_are_handed_out_in_order_once_and_again_when_they_are_lost() -> None:
    sweep = Sweep({**SEVEN, "seeds": {"count": 4}, "grid": {"sensor.noise_um": [0.1, 0.2]}})
    keys = [key for key, _, _ in sweep.runs()]
    remaining = Remaining(sweep, lambda some: {keys[1], keys[6], "of another"} & {*some, "of another"})
    assert (remaining.total, len(remaining), remaining.waiting) == (8, 8, 8), "nothing is looked for before its turn"
    first = [*remaining.take(3), *remaining.take(1)]
    assert [key for key, _, _ in first] == [keys[0], keys[2], keys[3]]
    assert (len(remaining), remaining.waiting) == (7, 4)
    assert [(point.labels["sensor.noise_um"], seed) for _, point, seed in first] == [(0.1, 1), (0.1, 3), (0.1, 4)]
    assert len({id(point) for _, point, _ in first[:2]}) == 1, "runs of a point share it, and the worker reads it once"
    remaining.finish(keys[2])
    remaining.finish("nobody's")
    assert (len(remaining), remaining.waiting) == (6, 4)
    remaining.take_back()
    assert [key for key, _, _ in remaining.take(99)] == [keys[n] for n in (0, 3, 4, 5, 7)]
    assert len(remaining) == 5
    assert remaining.take(1) == [] and remaining.waiting == 0
    for key in keys:
        remaining.finish(key)
    assert not remaining


def test_points_of_one_content_count_once() -> None:
    variants = [
        {"name": name, "set": {"sensor.noise_um": noise}} for name, noise in (("a", 0.1), ("b", 0.2), ("c", 0.1))
    ]
    remaining = Remaining(Sweep({**SEVEN, "seeds": {"count": 3}, "variants": variants}), nothing)
    assert [point.labels["variant"] for _, point, _ in remaining.take(9)] == ["a"] * 3 + ["b"] * 3
    assert (remaining.total, len(remaining), remaining.waiting) == (6, 6, 0)


def test_what_the_table_has_is_passed_over_in_ever_larger_steps() -> None:
    """A resumed campaign has most of its runs: it comes to the first missing run with few questions."""
    sweep, asked = Sweep({**SEVEN, "seeds": {"count": 20_000}}), list[int]()
    lacks = {sweep.key(19_998), sweep.key(19_999)}

    def have(keys: Sequence[str]) -> set[str]:
        asked.append(len(keys))
        return set(keys) - lacks

    remaining = Remaining(sweep, have)
    while not (taken := remaining.take(1)):
        assert remaining.waiting
    assert taken[0][0] == sweep.key(19_998) and len(asked) < 20 and max(asked) <= MOST_AT_ONCE
    assert [key for key, _, _ in remaining.take(1)] == [sweep.key(19_999)]
    assert remaining.take(1) == [] and (remaining.total, len(remaining)) == (20_000, 2)


def test_the_first_runs_need_their_own_points_and_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    hypercube = {"points": 10_000, "ranges": {"sensor.noise_um": {"min": 0.01, "max": 0.2}}}
    hashed: list[int] = []
    content = points.content_hash
    monkeypatch.setattr(points, "content_hash", lambda document: (hashed.append(1), content(document))[1])
    remaining = Remaining(Sweep({**SEVEN, "latin_hypercube": hypercube}), nothing)
    assert len(remaining.take(4)) == 4 == len(hashed)


def test_a_point_of_which_no_scenario_comes_has_keys_of_its_own() -> None:
    wrong = [{"plant.model": "none"}, {"plant.model": "neither"}, {"samples.of": 1}]
    sweep = Sweep({**SEVEN, "variants": [{"name": str(number), "set": one} for number, one in enumerate(wrong)]})
    assert len({sweep.key(number) for number in range(3)}) == 3


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
