"""Benches drawn by chance, and every block of the catalogue: the same bits in every way that the project has."""

from __future__ import annotations

from typing import Any

import pytest

from tests.core.test_conformance import NAMES, cases
from tests.scenarios import digests, ways

BENCHES, TICKS = 200, 120
FEW, SHORT = 3, 60
WAYS = [ways.PLAIN, "8", "16", ways.WALL]


def of_the_catalogue(name: str) -> dict[str, Any]:
    """Return a scenario with a block on it, without commands that wait for a condition."""
    case = cases(name)[f"{name} step" if name.startswith("faults/") else name]
    events = [command for command in case["commands"] if "when" not in command]
    return {**case["bench"], "schema": 1, "id": name.replace("/", "-"), "samples": TICKS, "events": events}


def unlike(scenarios: list[dict[str, Any]], way: str) -> tuple[list[str], int]:
    """Return which of scenarios give other results than boards alone, and how many could run in this way."""
    alone, found = ways.results(scenarios, ways.ALONE), ways.results(scenarios, way)
    pairs = zip(scenarios, alone, found, strict=True)
    return [one["id"] for one, old, new in pairs if new.items() - old.items()], sum(map(bool, found))


@pytest.mark.long
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("way", WAYS)
def test_benches_drawn_by_chance_are_the_same_in_every_way(way: str, drawn_seed: int) -> None:
    scenarios = [digests.draw_bench(number, drawn_seed, TICKS) for number in range(BENCHES)]
    different, ran = unlike(scenarios, way)
    print(f"seed {drawn_seed}, way {way}: {ran} of {len(scenarios)} ran")
    assert different == [] and ran >= (0.4 * BENCHES if way.isdigit() else BENCHES)


@pytest.mark.long
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("way", WAYS)
def test_every_block_of_the_catalogue_is_the_same_in_every_way(way: str) -> None:
    scenarios = [of_the_catalogue(name) for name in NAMES]
    different, ran = unlike(scenarios, way)
    print(f"way {way}: {ran} of {len(scenarios)} ran")
    assert different == [] and ran >= (0.8 * len(NAMES) if way.isdigit() else len(NAMES))


@pytest.mark.parametrize("number", range(FEW))
def test_a_few_benches_drawn_by_chance_are_the_same_in_plain_python_and_abreast(number: int) -> None:
    document = digests.draw_bench(number, digests.SEED + 1, SHORT)
    alone = ways.result(document, ways.ALONE)
    for way in (ways.PLAIN, "abreast"):
        assert not ways.result(document, way).items() - alone.items(), way


def test_a_bench_is_the_same_with_all_steps_behind_the_wall() -> None:
    document = digests.draw_bench(0, digests.SEED + 1, SHORT)
    assert ways.result(document, ways.WALL) == ways.result(document, ways.ALONE)
