"""Scenarios of supervised loops: each expectation of a supervisor fails when the supervisor is taken out."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

from core.errors import InputError
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from scenarios.studies import fault_tolerance

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


def test_the_table_of_laws_is_of_a_bench_with_a_supervisor() -> None:
    document = {key: value for key, value in get("ch5-tolerance-table").document.items() if key != "supervisor"}
    with pytest.raises(InputError, match="no supervisor"):
        run(Scenario.load(document))


def test_the_ratio_of_the_table_is_the_ratio_of_two_runs() -> None:
    table = get("ch5-tolerance-table").document
    short = {"study": {"kind": "fault_tolerance", "runs": 1, "samples": 1600}}
    found = run(Scenario.load({**table, **short, "expect": []})).metrics["tolerance.supervised.stiffness.100"]
    alone = {key: value for key, value in table.items() if key not in ("study", "expect")}
    alone |= {"samples": 1600, "events": [{"at_sample": 400, "fault": "stiffness", "severity": 0.1}]}
    errors = []
    for document in (alone, {key: value for key, value in alone.items() if key != "supervisor"}):
        result = run(Scenario.load(document))
        error = result.signal("plant.displacement") - result.signal("model.displacement")
        errors.append(np.sqrt(np.mean(np.square(error[1000:]))))
    assert found == pytest.approx(errors[0] / errors[1], rel=1e-12)


def test_the_table_at_several_noises_is_a_table_of_each(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each figure has the bits of the bench at that noise; the counts follow from the ratios."""
    cases = {"stiffness": ("stiffness", 0.1), "damping": ("damping", 0.3)}
    monkeypatch.setattr(fault_tolerance, "CASES", cases)
    monkeypatch.setattr(fault_tolerance, "SHARES", (0.5, 1.0))
    table = {**get("ch5-tolerance-table").document, "expect": []}

    def figures(noise_um: float, **study: Any) -> dict[str, float]:
        own = {"kind": "fault_tolerance", "runs": 1, "samples": 1600, **study}
        scenario = Scenario.load({**table, "sensor": {"kind": "ideal", "noise_um": noise_um}, "study": own})
        return {name: value for name, value in run(scenario).metrics.items() if name.startswith("tolerance.")}

    both = figures(0.05, noises_um=[0.01, 0.2])
    for noise_um, end in ((0.01, "10"), (0.2, "200")):
        alone = figures(noise_um)
        assert len(alone) == 12
        for name, value in alone.items():
            assert both.pop(f"{name}.{end}") == value
        for law in ("pid", "mrac"):
            pairs = [(alone[name.replace("supervised", law)], alone[name]) for name in alone if "supervised" in name]
            assert both.pop(f"tolerance.{law}.as_well.{end}") == sum(own <= 1.1 * other for own, other in pairs)
    assert not both
