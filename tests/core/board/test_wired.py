"""A bench with the sections of another takes over its wiring: the numbers are those of a bench wired alone."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np
import pytest

from core.board import wired
from core.board.board import Board
from core.board.parse import changed
from core.board.spec import Spec
from core.board.wiring import Wiring, wire
from scenarios.library import get
from scenarios.run import run

ARRAYS = ("table", "p", "s", "w", "io", "tap_rows", "endless")


@pytest.fixture(autouse=True)
def kept(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Begin without known benches; return the calls of `wire`."""
    calls: list[Any] = []

    def counted(spec: Spec, *arguments: Any, **named: Any) -> Wiring:
        calls.append(spec)
        return wire(spec, *arguments, **named)

    monkeypatch.setattr(wired, "_last", deque(maxlen=wired.MOST))
    monkeypatch.setattr(wired, "wire", counted)
    return calls


def same(one: Wiring, other: Wiring) -> None:
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)
    assert (one.instances, one.unread, one.absent) == (other.instances, other.unread, other.absent)
    assert one.signals.names == other.signals.names and one.index == other.index


@pytest.mark.parametrize("name", ["ch5-seven-step", "first-look", "ch5-detectors"])
def test_another_seed_has_the_numbers_of_a_bench_wired_alone(name: str, kept: list[Any]) -> None:
    """The second bench of a kind notes the facts, so the third is made from them."""
    spec = get(name).spec
    specs = [spec, spec, *(changed(spec, {"seed": seed}) for seed in (901, 902, 903))]
    found = [wired.wired(one) for one in specs]
    assert kept == [spec, specs[2]]
    for one, own in zip(found, specs, strict=True):
        same(one, wire(own))
    assert not np.array_equal(found[3].p, found[4].p)


def test_what_one_board_does_changes_no_other() -> None:
    spec = get("first-look").spec
    first = Board(spec)
    first.advance(300)
    first.wiring.p[:] = 7.0
    same(Board(spec).wiring, wire(spec))


def test_other_numbers_or_faults_are_wired_anew(kept: list[Any]) -> None:
    scenario = get("first-look")
    other = changed(scenario.spec, {"controllers.mrac.adaptation_gain": 2.5, "controller.kind": "mrac"})
    faulty = scenario.spec.with_faults(dict.fromkeys(["mass"], scenario.spec.plant.params))
    for spec in (scenario.spec, other):
        same(wired.wired(spec), wire(spec))
    assert kept == [scenario.spec, other]
    assert not wired._is_like(faulty, faulty) and not wired._is_like(scenario.spec, other)


def test_runs_over_seeds_have_the_same_bits_in_any_order() -> None:
    scenario = get("ch5-seven-step")
    digests = {seed: run(scenario, seed).digest for seed in (3, 1, 2)}
    wired._last.clear()
    assert {seed: run(scenario, seed).digest for seed in (1, 2, 3)} == digests
    assert len(set(digests.values())) == 3


def test_only_the_last_benches_are_kept() -> None:
    spec = get("first-look").spec
    for at in range(wired.MOST + 3):
        wired.wired(changed(spec, {"controllers.mrac.adaptation_gain": 1.0 + at}))
    assert len(wired._last) == wired.MOST
