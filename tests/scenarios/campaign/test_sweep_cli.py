"""A campaign from the command line: a folder with report and tables; gone on with, refused, interrupted."""

from __future__ import annotations

import json
import re
import sqlite3
import tomllib
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import pyarrow.csv
import pyarrow.parquet as pq
import pytest
from jsonschema_rs import Draft202012Validator
from typer.testing import CliRunner

from scenarios.campaign.campaign import Stopped
from scenarios.campaign.executor import Processes
from scenarios.campaign.survey import listed
from scenarios.edit import with_values
from scenarios.json_schema.documents import json_schema
from scenarios.library import get
from scenarios.run import run
from server.cli import sweep as sweeping
from server.cli.main import app
from server.store.lock import lock

CAMPAIGN = """
schema = 1
id = "who-notices"
title = "Two controllers, two diagnosers"
scenario = "ch5-seven-step"
set = { samples = 3000 }
seeds = "5:7"

[[variants]]
name = "sharp"
set = { "diagnosers.kalman.probability_floor" = 1e-3 }

[[variants]]
name = "as printed"
set = { "diagnosers.kalman.probability_floor" = 0.0 }

[grid]
"controller.kind" = ["open_loop", "mrac"]
"""


@pytest.fixture
def sweep(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(CAMPAIGN)
    runner = CliRunner()
    return lambda *more: runner.invoke(app, ["sweep", "mine.toml", *more], catch_exceptions=False)


def made(folder: Path) -> dict[str, str]:
    """When each result was put into the run table."""
    with sqlite3.connect(folder / "campaign.sqlite3") as connection:
        found = dict(connection.execute("SELECT key, created FROM results"))
    connection.close()
    return found


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_campaign_leaves_report_and_tables(sweep: Any, tmp_path: Path) -> None:
    ended = sweep("--workers", "1")
    assert ended.exit_code == 0 and "12 of 12 runs, 0 could not be carried out" in ended.stdout, ended.stderr
    folder = tmp_path / "sweeps" / "who-notices"
    table = pq.read_table(folder / "runs.parquet")
    assert table.num_rows == 12 and pyarrow.csv.read_csv(folder / "runs.csv").num_rows == 12
    assert set(table["controller.kind"].to_pylist()) == {"open_loop", "mrac"}
    row = next(
        row for row in table.to_pylist()
        if (row["variant"], row["controller.kind"], row["seed"]) == ("as printed", "mrac", 6)
    )  # fmt: skip
    values = {"samples": 3000, "controller.kind": "mrac", "diagnosers.kalman.probability_floor": 0.0}
    assert row["digest"] == run(with_values(get("ch5-seven-step"), values), 6).digest
    kept = (folder / "campaign.toml").read_text("utf-8")
    assert kept.startswith("#:schema ./campaign.schema.json\n")
    Draft202012Validator(json_schema("campaign")).validate(tomllib.loads(kept))
    report = (folder / "report.html").read_text()
    assert "12 of 12 runs" in report and "Receiver operating characteristic" in report and "Detection delay" in report
    assert "as printed, kind mrac" in report and not re.search(r"(src|href)=|url\(|@import|<script|<link", report)
    assert len(json.loads((folder / "points.json").read_text())) == 4
    # again without --resume: refused in one line; with it nothing is computed twice, and a larger campaign continues
    before = made(folder)
    again = sweep()
    assert again.exit_code == 2 and "--resume" in again.stderr and len(again.stderr.strip().splitlines()) == 1
    assert sweep("--resume", "--workers", "1").exit_code == 0 and made(folder) == before
    (tmp_path / "mine.toml").write_text(CAMPAIGN.replace("5:7", "5:8"))
    assert "16 of 16 runs" in sweep("--resume", "--workers", "1").stdout
    assert before.items() <= made(folder).items() and len(made(folder)) == 16
    for name in ("runs.parquet", "runs"):
        assert sorted(pq.read_table(folder / name)["key"].to_pylist()) == sorted(made(folder))


@pytest.mark.parametrize("dead", [False, True], ids=["by the processes", "here, as they are dead"])
def test_many_points_are_listed_in_pieces_as_few_are_at_once(
    sweep: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, dead: bool
) -> None:
    assert sweep("--out", "here", "--workers", "1").exit_code == 0
    at_once = json.loads((tmp_path / "here" / "points.json").read_text())
    asked = []

    def submit(self: Processes, function: Any, /, *arguments: Any) -> Any:
        asked.append(function)
        if dead and function is listed:
            raise BrokenProcessPool("a process died")
        return handed_over(self, function, *arguments)

    handed_over = Processes.submit
    monkeypatch.setattr(Processes, "submit", submit)
    monkeypatch.setattr(sweeping, "FEW_LISTED", 1)
    assert sweep("--out", "here", "--workers", "1", "--resume").exit_code == 0
    assert asked == [listed] * (1 if dead else 4)
    assert json.loads((tmp_path / "here" / "points.json").read_text()) == at_once


def test_the_results_of_another_campaign_are_left_alone(sweep: Any, tmp_path: Path) -> None:
    short = 'schema = 1\nscenario = "ch5-seven-step"\nset.samples = 50\n'
    (tmp_path / "mine.toml").write_text(short + 'id = "one"\n')
    assert sweep("--out", "here", "--workers", "1").exit_code == 0
    before = files(tmp_path / "here")
    (tmp_path / "mine.toml").write_text(short + 'id = "two"\n')
    refused = sweep("--out", "here", "--workers", "1", "--resume")
    assert refused.exit_code == 2 and "here holds the campaign one, not two" in refused.stderr
    assert len(refused.stderr.strip().splitlines()) == 1
    assert files(tmp_path / "here") == before
    (tmp_path / "mine.toml").write_text((tmp_path / "here" / "campaign.toml").read_text())  # the campaign that was run
    assert sweep("--out", "here", "--resume").exit_code == 0


def test_a_folder_takes_one_campaign_at_a_time(sweep: Any, tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    with lock(tmp_path / "here", "--out"):
        refused = sweep("--out", "here", "--resume")
    assert refused.exit_code == 2 and "--out: here is in use by process" in refused.stderr
    assert len(refused.stderr.strip().splitlines()) == 1
    assert [path.name for path in (tmp_path / "here").iterdir()] == [".lock"], "nothing is written"


def test_one_that_stops_says_how_to_go_on(sweep: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def stops(*_: Any) -> None:
        raise Stopped("lost worker processes 5 times in a row; 3 of 12 runs are done")

    monkeypatch.setattr("scenarios.campaign.campaign.Campaign.run", stops)
    ended = sweep("--out", "here")
    assert ended.exit_code == 1 and "3 of 12 runs are done" in ended.stderr
    assert "continue with: combbench sweep mine.toml --out here --resume" in ended.stderr

    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("scenarios.campaign.campaign.Campaign.run", interrupted)
    ended = sweep("--out", "here", "--resume")
    assert ended.exit_code == 130 and "--resume" in ended.stderr


def test_a_run_that_cannot_be_carried_out_is_exit_1(sweep: Any, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(
        'schema = 1\nscenario = "ch5-seven-step"\nset.samples = 50\n'
        'grid."events.0.fault" = ["damping", "sensor_dropout"]\ngrid."events.0.severity" = [0.05, 5.0]\n'
    )
    ended = sweep("--workers", "1")
    assert ended.exit_code == 1 and "4 of 4 runs, 1 could not be carried out" in ended.stdout
    assert "Runs that could not be carried out" in (tmp_path / "sweeps" / "sweep" / "report.html").read_text()


BAD = [
    ("", ["--workers", "1", "--scheduler", "tcp://a:1"], "--scheduler"),
    ("", ["--scheduler", "nope"], "no address of a scheduler"),
    ("", ["--scheduler", "carrier-pigeon://a:1"], "no address of a scheduler"),
    ("", ["--scheduler", "tcp://a:70000"], "there is no port 70000"),
    ("", ["--scheduler", "tls://127.0.0.1:8786"], "DASK_DISTRIBUTED__COMM__TLS__CA_FILE"),
    ("nonsense = 1\n", [], "nonsense"),
    ("schema = ", [], "malformed"),
    ("x = " + "[" * 500, [], "sweep: nested too deeply, at most 50 levels"),
    ("set.device" + ".a" * 500 + " = 1", [], "sweep: nested too deeply, at most 50 levels"),
    ('[grid]\n"device' + ".a" * 500 + '" = [1]\n', [], "nested too deeply, at most 50 levels"),
    ('[grid]\n"controller.kind" = []\n', [], "grid.controller.kind"),
    ('[grid]\n"events.0.severity" = [0.05, 1e9]\n', [], "events.0.severity: must be <= 20"),
    ('[grid]\n"controller.knd" = ["pid"]\n', [], "controller.knd"),
]


@pytest.mark.parametrize(("text", "more", "word"), BAD)
def test_a_wrong_campaign_is_exit_2_and_one_line(
    sweep: Any, tmp_path: Path, text: str, more: list[str], word: str
) -> None:
    (tmp_path / "mine.toml").write_text('schema = 1\nscenario = "ch5-seven-step"\n' + text)
    ended = sweep(*more)
    assert ended.exit_code == 2 and ended.stdout == ""
    assert len(ended.stderr.strip().splitlines()) == 1 and word in ended.stderr, ended.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"], "nothing is written"
