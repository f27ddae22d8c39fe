"""Runs print their warnings; an analogue drive with feedback is refused."""

from __future__ import annotations

import json
from typing import Any

import pytest
from typer.testing import CliRunner

from core.errors import InputError
from scenarios.campaign.single import run_seeds
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.report.run import run_report
from scenarios.run import run
from scenarios.schema import Scenario
from server.cli.main import app
from tests.lab import do, make, play

SEVEN, SHORT = "ch5-seven-step", {"samples": 500}
SLOW = {"diagnosers": {"slow": {"kind": "arx_bank", "every": 5}}}
LAYER = "stvsc: the boundary layer is thinner than one sample of switching: the law chatters"
STVSC: dict[str, Any] = {"controller.layer_um": 1e-4}


def call(*args: str) -> Any:
    return CliRunner().invoke(app, list(args), catch_exceptions=False)


def assigned(values: dict[str, Any]) -> list[str]:
    return [part for path, value in values.items() for part in ("--set", f"{path}={json.dumps(value)}")]


def test_a_run_tells_its_warnings_once_each():
    """Of a bank, before the first tick; of a block, when its tap rises, however often."""
    assert run(with_values(get(SEVEN), SHORT)).summary()["warnings"] == []
    told = run(with_values(get(SEVEN), {**SHORT, **SLOW})).summary()["warnings"]
    assert len(told) == 1 and told[0].startswith("slow weighs the voltages of 5 ticks")
    chattering = run(with_values(get("ch3-stvsc-mass"), STVSC))
    rises = [entry for entry in chattering.board.log if entry.kind == "warning"]
    assert rises and chattering.summary()["warnings"] == [LAYER]


def test_warnings_of_several_seeds_of_a_study_and_of_a_twin():
    slow = with_values(get(SEVEN), {**SHORT, **SLOW})
    assert run_seeds(slow, [1, 2])["warnings"] == run(slow).summary()["warnings"]
    study = {"study": {"kind": "flops"}, **SLOW}
    assert run(with_values(get("ch5-flops"), study)).summary()["warnings"] == run(slow).summary()["warnings"]
    twin = with_values(get(SEVEN), {**SHORT, "twins": {"other": SLOW}})
    assert run(twin).summary()["warnings"] == [f"other: {text}" for text in run(slow).summary()["warnings"]]


def test_a_campaign_tells_them(tmp_path):
    """On the command line, in its points, and in the report."""
    (tmp_path / "thin.toml").write_text(
        'schema = 1\nid = "thin"\nscenario = "ch3-stvsc-mass"\nseeds = "1:3"\n'
        "[set]\nduration_ms = 3\n[grid]\n'controller.layer_um' = [1e-4, 0.5]\n"
    )
    told = call("sweep", str(tmp_path / "thin.toml"), "--workers", "1", "--out", str(tmp_path / "out"))
    assert told.exit_code == 0 and told.stderr.count(f"combbench: warning: {LAYER}\n") == 1
    points = json.loads((tmp_path / "out" / "points.json").read_text())
    assert [point["warnings"] for point in points] == [[f"{LAYER} (3 runs)"], []]
    assert LAYER in (tmp_path / "out" / "report.html").read_text()


def test_the_command_line_and_the_report_tell_them():
    arguments = ["run", SEVEN, *assigned({**SHORT, "diagnosers.slow.kind": "arx_bank", "diagnosers.slow.every": 5})]
    found = json.loads(call(*arguments, "--json").stdout)["warnings"]
    assert len(found) == 1 and found[0].startswith("slow weighs")
    assert f"warning  {found[0]}" in call(*arguments).stdout
    gallery = json.loads(call("gallery", "--only", "ch1-bode-tolerances", "--json").stdout)
    assert [entry["warnings"] for entry in gallery] == [[]]
    result = run(with_values(get(SEVEN), {**SHORT, **SLOW}))
    assert f"Warning: {found[0]}" in run_report(result, result.summary())


@pytest.mark.parametrize("field", ["plant.drive", "drive.kind"])
def test_an_analogue_drive_with_feedback_is_refused_when_it_is_read(field):
    """By the name it was written at, on the command line with exit code 2."""
    document = {field.split(".")[0]: {field.split(".")[1]: "analogue"}, "controller.kind": "pid"}
    with pytest.raises(InputError) as caught:
        make(document)
    assert caught.value.field == field and "open_loop" in caught.value.message
    # the scenario says itself that its drive is held; the last word counts, however the field is spelt
    result = call("run", SEVEN, *assigned({field: "analogue", "controller.kind": "pid"}))
    assert result.exit_code == 2 and result.stdout == ""
    assert result.stderr.startswith(f"combbench: {field}: analogue is for open_loop only")


def test_a_drive_that_is_said_to_be_two_things_is_refused():
    with pytest.raises(InputError, match=r"plant\.drive says 'held' and drive\.kind 'analogue'"):
        Scenario.load({"schema": 1, "id": "x", "plant": {"drive": "held"}, "drive": {"kind": "analogue"}})
    both = {"schema": 1, "id": "x", "plant": {"drive": "analogue"}, "drive": {"kind": "analogue"}}
    assert Scenario.load(both).spec.context().analogue


def test_feedback_is_refused_while_the_drive_is_analogue_and_the_board_runs_on():
    board = make({"plant.drive": "analogue"})
    play(board, 10)
    for command in ({"switch": "mrac"}, {"switch": "mrac", "at_sample": 100}, {"set": {"controller.kind": "pid"}}):
        with pytest.raises(InputError) as caught:
            do(board, command)
        assert caught.value.field == "plant.drive"
    play(board, 200)
    assert board.spec.active == "open_loop" and board.tick == 210
    closed = make({"controller.kind": "pid"})
    with pytest.raises(InputError) as caught:
        do(closed, {"set": {"plant.drive": "analogue"}})
    assert caught.value.field == "plant.drive"


def test_an_event_that_would_close_the_loop_of_an_analogue_drive_is_refused_before_the_first_tick():
    with pytest.raises(InputError) as caught:
        with_values(get(SEVEN), {"plant.drive": "analogue", "events": [{"at_sample": 9, "switch": "pid"}]})
    assert caught.value.field.startswith("events.0") and "pid" in caught.value.message
