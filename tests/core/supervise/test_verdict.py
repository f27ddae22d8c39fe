"""From weights to a request, one sample after another: threshold, hold time, release, dead time, no hypothesis."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from core.board.parse import parse
from core.plain import plain
from core.supervise.retuning import Retuning
from core.supervise.switching import Switching
from tests.lab import RICH

COUNT = 3


def stepper(block: Any, **params: float) -> Any:
    """Return a function that gives a supervisor weights and a flag, and returns the request and its ports."""
    context = replace(parse(RICH).context(), dt_ms=0.1)
    own = block.Params(**params)
    p, s = block.Packed(block.packed(own, context)), block.State(block.initial(own, context))
    sizes = [COUNT if port.name == "probability" else max(1, len(port.names(own))) for port in block.Ports.declared]
    places = 2 + np.concatenate([[0], np.cumsum(sizes)])[:-1]
    signals = np.zeros(2 + sum(sizes))
    x, step = block.Ports(signals, places), plain(block.step)

    def feed(weights: list[float], unexplained: float = 0.0) -> float:
        for i, weight in enumerate(weights):
            x.probability[i] = weight
        names = {port.name: int(place) for port, place in zip(block.Ports.declared, places, strict=True)}
        signals[names["unexplained"]] = unexplained
        step(p, s, x)
        return float(x.request)

    feed.ports = x  # type: ignore[attr-defined]
    return feed


HEALTHY, HEAVY, UNSURE = [0.98, 0.01, 0.01], [0.02, 0.96, 0.02], [0.4, 0.5, 0.1]


def test_a_verdict_must_last_and_nothing_counts_in_the_dead_time() -> None:
    feed = stepper(Switching, hold_ms=0.5, dead_ms=1.0)
    assert [feed(HEALTHY) for _ in range(16)] == [0.0] * 14 + [1.0, 0.0]
    assert [feed(HEAVY) for _ in range(9)] == [0.0] * 9  # the dead time after an act
    assert [feed(HEAVY) for _ in range(6)] == [0.0] * 4 + [2.0, 0.0]


def test_a_verdict_that_is_interrupted_begins_anew() -> None:
    feed = stepper(Switching, hold_ms=0.5, dead_ms=0.0)
    got = [feed(weights) for weights in (*[HEAVY] * 4, UNSURE, *[HEAVY] * 5)]
    assert got == [0.0] * 9 + [2.0]


@pytest.mark.parametrize(("release", "wanted"), [(0.3, 0.0), (0.5, 1.0)])
def test_what_was_acted_on_is_left_below_the_release_alone(release: float, wanted: float) -> None:
    feed = stepper(Switching, hold_ms=0.1, dead_ms=0.0, threshold=0.55, release=release)
    assert feed(HEAVY) == 2.0
    assert feed([0.6, 0.35, 0.05]) == wanted


def test_no_verdict_below_the_threshold() -> None:
    feed = stepper(Switching, hold_ms=0.1, dead_ms=0.0, threshold=0.97)
    assert [feed(HEAVY) for _ in range(5)] == [0.0] * 5 and feed.ports.verdict == -1.0
    assert feed([np.nan] * 3) == 0.0


@pytest.mark.parametrize(("way", "wanted"), [("hold", 0.0), ("nominal", 4.0), ("safe", 4.0)])
def test_without_a_hypothesis_that_fits(way: Any, wanted: float) -> None:
    feed = stepper(Switching, hold_ms=0.2, dead_ms=0.0, on_unknown=way)
    assert [feed(HEAVY, 1.0) for _ in range(3)] == [0.0, wanted, 0.0]
    assert feed.ports.verdict == COUNT


def test_the_estimate_is_the_weighted_sum_of_the_hypotheses() -> None:
    feed = stepper(Retuning, hold_ms=0.0, dead_ms=0.0, least_change=0.01)
    assert feed([0.5, 0.3, 0.2]) == 1.0
    np.testing.assert_allclose(list(feed.ports.estimate[:4]), [1.015, 1.0, 1.06, 1.0], rtol=1e-12)
    assert feed([0.5, 0.3, 0.2]) == 0.0
    assert feed([0.48, 0.32, 0.2]) == 0.0  # a change of 0.001 is not worth it
    assert feed([0.0, 1.0, 0.0]) == 1.0
