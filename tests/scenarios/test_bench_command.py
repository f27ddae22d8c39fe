"""`combbench bench` prints the ratios to C with the machine they are of, and ends with 1 when the C differs."""

from __future__ import annotations

import json
import re

import pytest
from typer.testing import CliRunner

from scenarios.speed import machine as of_machine
from scenarios.speed import ratios
from scenarios.speed.figure import figure
from scenarios.speed.machine import machine
from server.cli import watchers as of_watchers
from server.cli.main import app
from server.cli.watchers import ROUNDS, Watched, watchers

HOST = {"processor": "Some CPU", "processors": 2, "vectors": ["AVX2"], "load": 7.25, "busy": True, "compiler": "gcc 12"}
COST = {"ours_ns": 1500.0, "ours_lower_quartile_ns": 1400.0}
IN_C = {"c_ns": 1e3, "c_lower_quartile_ns": 1e3, "ratio": 1.5, "ratio_of_lower_quartiles": 1.4, "goal": 1.15}


def said(monkeypatch, *options, **row):
    """Return the exit code and the lines of the command for one row against C."""
    report = {
        "machine": HOST,
        "anchor": [{"bench": "first-look", "part": "steps", **COST, **row}],
        "figures": [figure("a peer", [2.0], "x", least=1.0)],
        "blocks_ns": {},
        "missing": ["something is not measured"],
    }
    asked = []
    monkeypatch.setattr(ratios, "speed", lambda quick: asked.append(quick) or report)
    monkeypatch.setattr(of_watchers, "watchers", list)
    done = CliRunner().invoke(app, ["bench", *options], catch_exceptions=False)
    assert asked == ["--quick" in options]
    return done.exit_code, done.stdout


@pytest.mark.parametrize(("ok", "mark"), [(True, "ok  "), (False, "MISS")])
def test_a_row_has_both_costs_their_ratio_and_the_goal(ok, mark, monkeypatch):
    code, text = said(monkeypatch, "--quick", **IN_C, differences=[], ok=ok)
    first, busy, head, row, *_ = text.splitlines()
    assert first == "Some CPU, 2 processors, AVX2, gcc 12"
    assert busy.startswith("the machine is busy (load 7.2)")
    assert (
        re.sub(" +", " ", row) == f"{mark.strip()} first-look, steps 1.50 (1.40) us 1.00 (1.00) us 1.50 (1.40) <= 1.15"
    )
    assert head.endswith("goal") and code == 0


def test_c_with_other_bits_is_an_error_in_its_row_and_exit_1(monkeypatch):
    code, text = said(monkeypatch, **IN_C, differences=["digest", "state"], ok=False)
    (row,) = [line for line in text.splitlines() if line.startswith("ERR")]
    assert row.endswith("the C differs: digest, state") and code == 1


def test_without_a_compiler_a_row_has_the_cost_alone_and_the_last_line_says_why(monkeypatch):
    code, text = said(monkeypatch, ok=True)
    assert re.search(r"^info first-look, steps +1\.50 \(1\.40\) us$", text, re.MULTILINE)
    assert text.endswith("something is not measured\n") and code == 0


def test_the_document_says_whether_all_goals_are_reached(monkeypatch):
    assert json.loads(said(monkeypatch, "--json", ok=True)[1])["ok"] is True
    assert json.loads(said(monkeypatch, "--json", **IN_C, differences=[], ok=False)[1])["ok"] is False


@pytest.mark.parametrize(("load", "is_busy"), [(0.4, False), (1.6, True)])
def test_a_machine_is_busy_above_a_load_of_one(load, is_busy, monkeypatch):
    monkeypatch.setattr(of_machine.os, "getloadavg", lambda: (load, 0.0, 0.0))
    found = machine()
    assert found["busy"] is is_busy and found["processor"] and found["processors"] >= 1


def test_each_watcher_gets_each_picture():
    watched = Watched(3)
    assert watched.cost() > 0.0
    assert watched.metrics.sent.frames == 3 * ROUNDS


def test_a_further_watcher_is_told_over_the_first(monkeypatch):
    costs = {"1": [100.0, 200.0], "50": [1.0, 1.0], "200": [100.0 + 199.0, 200.0 + 4.0 * 199.0]}
    monkeypatch.setattr(of_watchers, "Watched", lambda count: type("None", (), {"cost": None}))
    monkeypatch.setattr(of_watchers, "interleaved", lambda _: costs)
    *pictures, further = watchers()
    assert [row["value"] for row in pictures] == pytest.approx([0.15, 0.001, 0.6475])
    assert (further["low"], further["high"]) == (pytest.approx(0.01), pytest.approx(0.02))
