"""Scenarios of supervised loops: each expectation of a supervisor fails when the supervisor is taken out."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario

SUPERVISED = ("ch5-fault-tolerant", "ch5-redesign", "ch5-wrong-verdict", "ch5-unknown-fault")
INDIFFERENT = ("twins.holding.", "control.", "twins.pid.", "twins.mrac.", "twins.blended.")
"""Figures of loops without a supervisor, or of one that does nothing by design."""


def without_supervisors(document: dict[str, Any]) -> dict[str, Any]:
    found = copy.deepcopy(document)
    for twin in found["twins"].values():
        twin.pop("supervisor", None)
    return found


@pytest.mark.parametrize("name", SUPERVISED)
def test_without_its_supervisor_a_scenario_shows_none_of_it(name: str) -> None:
    scenario = get(name)
    rows = [row for row in scenario.head.expect if not row.metric.startswith(INDIFFERENT)]
    bare = run(Scenario.load(without_supervisors(scenario.document))).metrics
    assert rows and [row.metric for row in rows if row.holds(bare.get(row.metric))] == []


def test_with_one_law_no_expectation_of_many_laws_holds() -> None:
    document = copy.deepcopy(get("ch5-multiple-model-control").document)
    for table in (document["controller"], document["twins"]["winner"]["controller"]):
        table["kind"] = "lqg"
        table.pop("combine", None)
    bare, rows = run(Scenario.load(document)).metrics, document["expect"]
    assert rows and [row["metric"] for row in rows if bare[row["metric"]] <= row["max"]] == []


def test_a_supervisor_that_holds_leaves_every_bit_of_the_loop() -> None:
    result = run(get("ch5-wrong-verdict"), taps=True)
    for signal in ("plant.displacement", "drive.voltage"):
        assert result.signal(signal).tobytes() == result.signal(f"holding:{signal}").tobytes()
