"""The trigger against an oracle that walks the samples one by one."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from server.stream import trigger as module
from server.stream.trigger import Trigger, crossing_time


class Samples:
    """A history of one signal that can grow and forget."""

    def __init__(self, values: Any, first: int = 0) -> None:
        self.values = np.asarray(values, np.float32)
        self.first_tick, self.end_tick = first, len(self.values)

    def read(self, signals: list[int], start: int, stop: int) -> NDArray[np.float32]:
        assert signals == [0] and start >= self.first_tick and stop <= self.end_tick
        return self.values[None, start:stop]


def walk(values: Any, edge: str, level: float, hysteresis: float, upper: float = 0.0) -> list[int]:
    """The definition of a crossing and of entering or leaving a window, one sample after the other."""
    heights: dict[str, Callable[[float], float]] = {
        "rising": lambda value: value - level,
        "falling": lambda value: level - value,
        "enters": lambda value: min(value - level, upper - value),  # how far it is within, less than 0 outside
        "leaves": lambda value: -min(value - level, upper - value),
    }
    found = []
    for height in (heights[one] for one in (("rising", "falling") if edge == "either" else (edge,))):
        ready = False
        for tick, value in enumerate(np.float64(np.asarray(values, np.float32))):
            if height(value) >= 0.0:
                if ready:
                    found.append(tick)
                ready = False
            elif height(value) < -hysteresis:
                ready = True
    return sorted(set(found))


class Moving(Samples):
    """A history that has lost its oldest ticks when it is read, because its bench continues; it does so until tick
    10."""

    def read(self, signals: list[int], start: int, stop: int) -> NDArray[np.float32]:
        self.first_tick = min(self.first_tick + 3, 10)
        return self.values[None, max(start, self.first_tick) : stop]


@pytest.mark.parametrize("block", [2, 5, 50])
def test_a_history_that_goes_on_during_a_scan_moves_no_crossing(block: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "BLOCK", block)
    values = np.tile([-1.0, -1.0, 1.0, 1.0, 1.0], 10)
    found = Trigger(0, "rising", 0.0, 0.5, 0).scan(Moving(values, first=4))
    assert found == list(range(12, 50, 5)) == walk(values, "rising", 0.0, 0.5)[2:]


signals = st.lists(st.sampled_from([-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, float("nan")]), max_size=60)


LEVELS = st.sampled_from([(-0.5, 0.5), (0.0, 0.5), (-1.0, 1.0), (0.5, 1.0)])
EDGES = st.sampled_from(["rising", "falling", "either", "enters", "leaves"])
PIECES = st.lists(st.integers(1, 20), max_size=20)


@settings(max_examples=60)
@given(signals, EDGES, LEVELS, st.sampled_from([0.0, 0.2, 0.4, 1.0]), PIECES, st.integers(1, 9))
def test_every_crossing_is_found_once_however_the_data_arrives(
    values: list[float], edge: Any, window: tuple[float, float], hysteresis: float, pieces: list[int], block: int
) -> None:
    level, upper = window
    if edge in ("enters", "leaves"):
        hysteresis = min(hysteresis, 0.4 * (upper - level))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "BLOCK", block)
        history, found, arrived = Samples(values), [], 0
        trigger = Trigger(0, edge, level, hysteresis, 0, upper if edge in ("enters", "leaves") else None)
        for piece in [*pieces, len(values)]:
            arrived = history.end_tick = min(arrived + piece, len(values))
            found += trigger.scan(history)
    assert found == walk(values, edge, level, hysteresis, upper)


def test_one_tick_outside_the_window_is_enough() -> None:
    spike = [0.0] * 1000
    spike[417] = -3.0
    assert Trigger(0, "leaves", -1.0, 0.1, 0, 1.0).scan(Samples(spike)) == [417]
    assert Trigger(0, "enters", -1.0, 0.1, 0, 1.0).scan(Samples(spike)) == [418]


@given(signals, st.sampled_from(["rising", "falling", "either"]), st.integers(1, 9))
def test_taken_one_by_one_they_are_the_same(values: list[float], edge: Any, block: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "BLOCK", block)
        history, trigger = Samples(values), Trigger(0, edge, 0.0, 0.4, 0)
        found: list[int] = []
        while True:
            one = trigger.scan(history, first_only=True)
            assert len(one) <= 1
            if not one:
                break
            found += one
    assert found == walk(values, edge, 0.0, 0.4)


def test_what_the_history_has_forgotten_cannot_trigger() -> None:
    values = np.tile([-1.0, 1.0], 50)
    trigger = Trigger(0, "rising", 0.0, 0.0, 0)
    assert trigger.scan(Samples(values, first=90)) == [91, 93, 95, 97, 99]


def test_noise_within_the_hysteresis_does_not_trigger_again() -> None:
    noisy = [-1.0, 0.1, -0.1, 0.1, -0.1, 0.1, -1.0, 0.1]
    assert Trigger(0, "rising", 0.0, 0.5, 0).scan(Samples(noisy)) == [1, 7]
    assert Trigger(0, "rising", 0.0, 0.0, 0).scan(Samples(noisy)) == [1, 3, 5, 7]


def test_a_crossing_is_placed_on_the_line_between_two_samples() -> None:
    history = Samples([-1.0, 3.0])
    assert crossing_time(history, 0, 1, 0.0) == pytest.approx(0.25)
    assert crossing_time(history, 0, 1, -2.0, 1.0) == pytest.approx(0.5)  # the level of the window that was crossed
    assert crossing_time(history, 0, 1, 1.0, 2.0) == pytest.approx(0.5)  # the first of both
    assert crossing_time(Samples([3.0, -1.0]), 0, 1, 0.0, math.inf) == pytest.approx(0.75)
    assert crossing_time(Samples([0.0, 0.0]), 0, 1, 5.0) == 1.0
