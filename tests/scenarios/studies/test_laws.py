"""The table of controllers: recomputed to the bit, a cell against a run of its own, its PID the best of its family."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.board.board import Board
from scenarios.comparator import FEEDFORWARD, POLES
from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from scenarios.studies.laws import Laws, spec_of
from scenarios.studies.laws import run as cell
from tests.lab import rms

TABLE: dict[str, float] = json.loads(Path(__file__).with_name("laws.json").read_text("utf-8"))
ID = "ch3-which-controller"


def scenario(**study: Any) -> Scenario:
    document = get(ID).document
    return Scenario.load({**document, "expect": [], "study": {**document["study"], **study}})


def figures(one: Scenario) -> dict[str, float]:
    return {name: value for name, value in run(one).metrics.items() if name.startswith("laws.")}


def test_a_part_of_the_table_has_its_bits() -> None:
    table = get(ID).document["study"]
    chosen = [law for law in table["laws"] if law["name"] in ("pid", "h_infinity", "mrac")]
    found = figures(scenario(laws=chosen, faults=table["faults"][2:4], noise_um=[0.0, 0.05]))
    cells = {name: value for name, value in found.items() if ".worst." not in name and not name.endswith(".trips")}
    assert len(cells) == 3 * 2 * 2 * 2
    assert cells == {name: TABLE[name] for name in cells}


@pytest.mark.long
def test_the_whole_table_has_its_bits() -> None:
    assert figures(get(ID)) == TABLE


def test_a_cell_is_the_tail_of_a_run_with_its_law_its_fault_and_its_noise() -> None:
    document = {name: value for name, value in get(ID).document.items() if name not in ("study", "expect")}
    events = [{"at_sample": 0, "fault": "stiffness", "severity": 0.8}]
    controller = {"kind": "adrc"}
    values = {"controller": controller, "sensor": {"kind": "ideal", "noise_um": 0.05}, "events": events}
    result = run(Scenario.load({**document, **values, "samples": 6000}), taps=True)
    tail = slice(3000, None)
    off = (result.signal("plant.displacement") - result.signal("model.displacement"))[tail]
    assert TABLE["laws.adrc.stiffer.50.error_um"] == pytest.approx(rms(off), rel=1e-12)
    effort = rms(result.signal("drive.voltage")[tail]) / rms(result.signal("reference.voltage")[tail])
    assert TABLE["laws.adrc.stiffer.50.effort"] == pytest.approx(effort, rel=1e-12)


def test_the_worst_of_a_law_is_the_largest_of_its_cells() -> None:
    names = [fault["name"] for fault in get(ID).document["study"]["faults"]]
    cells = [TABLE[f"laws.lqg.{name}.50.error_um"] for name in names]
    assert TABLE["laws.lqg.worst.50.error_um"] == max(cells) == cells[names.index("stiffer")]


def bench() -> Board:
    document = get(ID).document
    return Board(
        {name: document[name] for name in ("sample_rate_khz", "device", "plant", "reference", "model", "sensor")}
    )


def test_a_run_that_the_guard_ends_counts_with_its_travel() -> None:
    board = bench()
    error, effort = cell(board, spec_of(board, {"kind": "open_loop"}, 0.0), {"stiffness": -0.94}, 6000)
    assert error == 25.0
    assert np.isnan(effort)


def test_the_pid_is_the_best_of_its_family_on_the_healthy_device() -> None:
    board = bench()

    def error(pole: float, feedforward: float) -> float:
        pid = {"kind": "pid", "pole": pole, "feedforward": feedforward}
        return cell(board, spec_of(board, pid, 0.0), {}, 6000)[0]

    (own,) = (law["controller"] for law in get(ID).document["study"]["laws"] if law["name"] == "pid")
    assert own["pole"] == min(POLES, key=lambda pole: error(pole, 0.0))
    assert own["feedforward"] == min(FEEDFORWARD, key=lambda share: error(own["pole"], share))


def test_every_law_for_one_axis_is_in_the_table() -> None:
    named = {law["controller"]["kind"] for law in get(ID).document["study"]["laws"]}
    assert named == set(Board(bench().base).spec.controllers) - {"gain_adaptation", "multiple_model"}


def test_the_picture_has_a_curve_for_each_law() -> None:
    one = scenario(laws=get(ID).document["study"]["laws"][:2], faults=[{"name": "healthy"}], noise_um=[0.0, 0.0005])
    picture = Laws.picture(bench(), one.study[1])
    assert [name for name, *_ in picture.curves] == ["open_loop", "pid"]
    assert [list(x) for _, x, _ in picture.curves] == [[0.0, 0.5]] * 2
