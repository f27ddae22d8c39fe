"""Benches drawn by chance, and every block of the catalogue: the same bits in every way that the project has."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest

from tests.core.test_conformance import NAMES, cases
from tests.scenarios import digests, ways

BENCHES, TICKS = 200, 120
FEW, SHORT = 3, 60
WAYS = [ways.PLAIN, "8", "16", ways.WALL]


Scenarios = list[dict[str, Any]]


@cache
def drawn(seed: int) -> tuple[Scenarios, list[ways.Result]]:
    """Return benches drawn by chance, and their results as boards alone."""
    scenarios = [digests.draw_bench(number, seed, TICKS) for number in range(BENCHES)]
    return scenarios, ways.results(scenarios, ways.ALONE)


@cache
def catalogue() -> tuple[Scenarios, list[ways.Result]]:
    """Return a scenario with each block, without commands that wait for a condition, and their results."""
    scenarios = []
    for name in NAMES:
        case = cases(name)[f"{name} step" if name.startswith("faults/") else name]
        events = [command for command in case["commands"] if "when" not in command]
        row = {"schema": 1, "id": name.replace("/", "-").replace("_", "-"), "samples": TICKS, "events": events}
        scenarios.append({**case["bench"], **row})
    return scenarios, ways.results(scenarios, ways.ALONE)


def compare(scenarios: Scenarios, alone: list[ways.Result], way: str, least: float) -> None:
    """Compare the results of scenarios in some way with those of boards alone; at least so many can run in this way."""
    found = ways.results(scenarios, way)
    ran = sum(map(bool, found))
    print(f"{way}: {ran} of {len(scenarios)} ran")
    pairs = zip(scenarios, alone, found, strict=True)
    assert [one["id"] for one, old, new in pairs if new.items() - old.items()] == []
    assert ran >= (least if way.isdigit() else 1.0) * len(scenarios)


@pytest.mark.long
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("way", WAYS)
def test_benches_drawn_by_chance_are_the_same_in_every_way(way: str, drawn_seed: int) -> None:
    compare(*drawn(drawn_seed), way, 0.4)


@pytest.mark.long
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("way", WAYS)
def test_every_block_of_the_catalogue_is_the_same_in_every_way(way: str) -> None:
    compare(*catalogue(), way, 0.8)


@pytest.mark.parametrize("number", range(FEW))
def test_a_few_benches_drawn_by_chance_are_the_same_in_plain_python_and_abreast(number: int) -> None:
    document = digests.draw_bench(number, digests.SEED + 1, SHORT)
    alone = ways.result(document, ways.ALONE)
    for way in (ways.PLAIN, "abreast"):
        assert not ways.result(document, way).items() - alone.items(), way


def test_a_bench_is_the_same_with_all_steps_behind_the_wall() -> None:
    document = digests.draw_bench(0, digests.SEED + 1, SHORT)
    assert ways.result(document, ways.WALL) == ways.result(document, ways.ALONE)
