"""A scenario is parsed once, all its boards are built from that, and none of them changes it."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

from core.board import parse
from core.board.board import Board
from core.board.ensemble import Ensemble, make, twin_documents
from core.errors import InputError
from scenarios.library import library
from scenarios.run import build, run
from scenarios.schema import Scenario
from tests.lab import RICH, do, document, inject

TWINS = {"held": {"controller": {"kind": "open_loop"}}, "narrow": {"plant": {"model": "nonlinear"}}}


def bench(**more: Any) -> dict[str, Any]:
    events = [{"fault": "added_mass", "severity": 0.05, "at_sample": 200}]
    return {**document({"controller.kind": "mrac"}, RICH), "samples": 700, "events": events, **more}


@pytest.fixture
def parsed(monkeypatch):
    calls = []
    original = parse._parse

    def counting(doc: Any, before: Any) -> Any:
        calls.append("anew" if before is None else "changed")
        return original(doc, before)

    monkeypatch.setattr(parse, "_parse", counting)
    return calls


def test_a_run_parses_its_scenario_once(parsed):
    scenario = Scenario.load(bench())
    assert parsed == ["anew"]
    run(scenario)
    assert parsed == ["anew"]


def test_a_run_with_twins_parses_each_once(parsed):
    result = run(Scenario.load(bench(twins=TWINS)))
    assert isinstance(result.board, Ensemble)
    assert parsed == ["anew"] * 3


def test_another_seed_checks_the_seed_and_no_section_again(parsed, monkeypatch):
    scenario = Scenario.load(bench(twins=TWINS))
    parsed.clear()
    monkeypatch.setattr(parse, "_params", None)  # whatever checks the parameters of a block would fail
    board = build(scenario, 7)
    assert parsed == ["changed"] * 3
    assert isinstance(board, Ensemble)
    assert [one.spec.seed for one in (board, *board.twins.values())] == [7] * 3
    assert scenario.spec.seed == RICH["seed"]


@pytest.mark.parametrize("seed", [-1, 2**53 + 1])
def test_a_seed_out_of_range_is_refused_by_name(seed: int):
    with pytest.raises(InputError) as refused:
        build(Scenario.load(bench(twins=TWINS)), seed)
    assert refused.value.field == "seed"


def unlike_its_document(scenario: Scenario) -> list[str]:
    """Return the seeds at which a board from the spec is not the board from the document."""
    # Events of the first tick change the bench; expectations may name them as fitted.
    scenario, wrong = Scenario.load({**scenario.document, "events": [], "expect": []}), []
    for seed in (None, 7):
        whole = scenario.bench if seed is None else {**scenario.bench, "seed": seed}
        ours, fresh = build(scenario, seed), make(whole)
        alike = ours.spec == fresh.spec and ours.base == fresh.base and ours.signals.names == fresh.signals.names
        wrong += [] if type(ours) is type(fresh) and alike else [f"{scenario.id} at seed {seed}"]
    return wrong


def test_a_board_of_each_plant_from_a_spec_is_the_board_from_the_document():
    plants = {(one.spec.plant.block, bool(one.twins), one.study is None): one for one in library()}
    assert len(plants) > 8 and [text for one in plants.values() for text in unlike_its_document(one)] == []


@pytest.mark.long
def test_a_board_from_a_spec_is_the_board_from_the_document():
    assert [text for one in library() for text in unlike_its_document(one)] == []


def test_twins_from_specs_are_the_twins_from_the_document():
    scenario = Scenario.load(bench(twins=TWINS))
    ours, fresh = build(scenario, 7), make({**scenario.bench, "seed": 7})
    assert isinstance(ours, Ensemble) and isinstance(fresh, Ensemble)
    assert ours.base == fresh.base and ours.spec == fresh.spec and "twins" not in ours.spec.document
    assert {name: twin.spec for name, twin in ours.twins.items()} == {
        name: twin.spec for name, twin in fresh.twins.items()
    }
    for name, own in twin_documents({**scenario.bench, "seed": 7}).items():
        assert Board(own).spec == ours.twins[name].spec


def disturb(board: Board) -> None:
    """Do to a board what changes it: a fault, values, another controller, and the fault healed."""
    inject(board, stiffness=0.2)
    do(board, {"set": {"reference.amplitude_v": 3.0, "sensors.ideal.noise_um": 0.5}})
    do(board, {"set": {"environment.temperature_k": 350.0, "diagnosers.kalman.every": 1}})
    do(board, {"switch": "open_loop"})
    board.advance(400)
    do(board, {"heal": "all"})
    board.advance(300)


@pytest.mark.parametrize("twins", [{}, TWINS], ids=["alone", "with twins"])
def test_boards_of_one_scenario_share_nothing_that_changes(twins):
    scenario = Scenario.load(bench(twins=twins))
    kept = copy.deepcopy([scenario.document, scenario.bench, scenario.spec, scenario.twins])
    first, second = build(scenario), build(scenario)
    base = copy.deepcopy(second.base)
    disturb(first)
    first.base["device"]["id"] = "other"
    assert [scenario.document, scenario.bench, scenario.spec, scenario.twins] == kept
    assert second.base == base
    untouched = build(Scenario.load(bench(twins=twins)))
    while second.tick < 700:
        ours, fresh = second.advance(256), untouched.advance(256)
        assert np.array_equal(ours.outputs, fresh.outputs, equal_nan=True)
        assert np.array_equal(ours.taps, fresh.taps, equal_nan=True)
    assert second.digest() == untouched.digest() != first.digest()
