"""Every noisy scenario of the library keeps its expectations over fifty seeds, not at the one it is shown with."""

from __future__ import annotations

import pytest

from scenarios.library import library
from scenarios.run import run
from scenarios.schema import Scenario
from tests.scenarios.fast_run import fast, figures

SEEDS = range(1, 51)
MOST_MISSED = 2
"""Seeds of the fifty at which an expectation may miss: the others are at least 95 %."""


def longest_first() -> list[Scenario]:
    """Return the scenarios in an order in which no process is left with a long one in the end."""
    return sorted(library(), key=lambda scenario: scenario.samples or 0, reverse=True)


@pytest.mark.long
@pytest.mark.timeout(900)
@pytest.mark.parametrize("scenario", longest_first(), ids=lambda scenario: scenario.id)
def test_a_claim_holds_over_seeds(scenario: Scenario) -> None:
    if not scenario.head.expect:
        pytest.skip("claims nothing")
    missed: list[list[str]] = []
    before: dict[str, float] = {}
    with fast():
        for seed, found in zip(SEEDS, figures(scenario, SEEDS), strict=True):
            if seed == SEEDS[1] and found == before:
                pytest.skip("nothing is left to chance")
            before = found
            wrong = [entry.metric for entry in scenario.head.expect if not entry.holds(found.get(entry.metric))]
            missed += [wrong] if wrong else []
            assert len(missed) <= MOST_MISSED, f"misses at {len(missed)} of the first {seed} seeds: {missed}"
            if seed - len(missed) == len(SEEDS) - MOST_MISSED:
                break  # whatever the others give


@pytest.mark.long
@pytest.mark.parametrize(
    "name", ["ch5-seven-step", "ch3-pull-in-map", "gyro-diagnosis", "ch6-drift", "ch2-doppler", "gyro-allan"]
)
def test_the_fast_run_gives_the_figures_of_a_run(name: str) -> None:
    scenario = next(entry for entry in library() if entry.id == name)
    with fast():
        found = [*figures(scenario, [1, 2, 3])][-1]
    metrics = run(scenario, 3).metrics
    for entry in scenario.head.expect:
        assert found[entry.metric] == pytest.approx(metrics[entry.metric], rel=1e-12)
