"""`combbench replay` and `combbench diagnose`: figures, verdicts, refusals, exit codes."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from core.measured_record import MeasuredRecord
from scenarios.records.shelf import RecordFolder
from scenarios.run import RunResult
from server.cli.main import app
from tests.scenarios.records.foreign import DT, Foreign, draw

Call = Callable[..., Any]


@pytest.fixture
def call(folder: RecordFolder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Call:
    monkeypatch.chdir(tmp_path)
    return lambda *args: CliRunner().invoke(app, [str(arg) for arg in args], catch_exceptions=False)


def written(path: Path, drive: np.ndarray, displacement: np.ndarray, head: str = "time_ms,drive,displacement") -> Path:
    rows = zip((np.arange(len(drive)) * DT).tolist(), drive.tolist(), displacement.tolist(), strict=True)
    path.write_text("\n".join([head, *(f"{t!r},{u!r},{y!r}" for t, u, y in rows)]))
    return path


def foreign(path: Path, one: Foreign, samples: int) -> Path:
    return written(path, one.drive[:samples], one.displacement[:samples])


def test_replay_gives_the_figures_of_a_run_and_keeps_the_record(
    call: Call, own: MeasuredRecord, seven: RunResult, folder: RecordFolder, tmp_path: Path
) -> None:
    file = written(tmp_path / "own.csv", own.drive, own.displacement)
    found = json.loads(call("replay", file, "--scenario", "ch5-seven-step", "--json").output)
    assert found["ticks"] == own.samples and "control.rms_error_um" not in found["metrics"]
    assert found["metrics"]["device.mass_kg"] == seven.metrics["device.mass_kg"]
    assert [*folder.keys()] == [found["record"]["key"]]


def test_diagnose_tells_a_fault_from_health_by_its_exit_code(call: Call, tmp_path: Path) -> None:
    one = draw(1)
    healthy = call("diagnose", foreign(tmp_path / "healthy.csv", one, 2000), "--healthy", "0:1200")
    assert healthy.exit_code == 0 and "95 % interval" in healthy.output and "healthy" in healthy.output
    fault = call("diagnose", foreign(tmp_path / "fault.csv", one, 3000), "--healthy", "0:2000", "--json")
    found = json.loads(fault.output)
    names = ("healthy", "m+5", "m+10", "k+5", "k+10", "b+30")
    assert fault.exit_code == found["exit"] == 1
    assert found["verdicts"]["kalman"][-1]["verdict"] == names[one.truth[2999]] != "healthy"
    assert found["calibration"]["mass"]["value"] == pytest.approx(one.ratios["mass"], rel=0.01)


def test_a_report_is_one_file_that_says_the_verdict(call: Call, tmp_path: Path) -> None:
    file = foreign(tmp_path / "<b>fault.csv", draw(1), 3000)
    said = call("diagnose", file, "--healthy", "0:2000", "--html", "a.html", "--json")
    page, found = (tmp_path / "a.html").read_text(), json.loads(said.output)
    assert found["outcome"] == "fault" and escape(found["sentence"]) in page
    assert "A controller cannot drive a record" in page and "&lt;b&gt;fault.csv" in page
    for entry in found["verdicts"]["kalman"]:
        assert f"<td>{entry['first']}</td><td>{entry['end']}</td><td>{entry['verdict']}</td>" in page
    assert page.count("<svg") == 5 and not re.search(r"(src|href)=|url\(|<script|<link", page)
    unwritten = call("diagnose", file, "--healthy", "0:2000", "--html", "nowhere/a.html")
    assert unwritten.exit_code == 2 and "--html: cannot write nowhere/a.html" in unwritten.stderr


def test_a_report_is_as_loud_about_a_record_that_no_hypothesis_explains(call: Call, tmp_path: Path) -> None:
    one = draw(1, samples=4000)
    y = one.displacement.copy()
    y[2000:] += 0.3 * np.sin(np.arange(2000))
    said = call("diagnose", written(tmp_path / "odd.csv", one.drive, y), "--healthy", "0:2000", "--html", "a.html")
    assert said.exit_code == 3 and "Unexplained: no hypothesis of kalman fits" in said.output
    assert '<p class="outcome bad">Unexplained: no hypothesis' in (tmp_path / "a.html").read_text()


def test_a_record_that_does_not_fit_is_refused_with_the_reason(call: Call, tmp_path: Path) -> None:
    refused = call(
        "diagnose",
        foreign(tmp_path / "rubbed.csv", draw(3, "friction"), 2400),
        "--healthy",
        "0:2000",
        "--html",
        "a.html",
    )
    assert refused.exit_code == 3 and "REFUSED: friction explains" in refused.output
    page = (tmp_path / "a.html").read_text()
    assert '<p class="outcome bad">Refused: friction explains' in page and "does not hold" in page


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--healthy", "start"), "--healthy: must be A:B"),
        (("--healthy", "0:100"), "healthy: has 100 samples"),
        (("--map", "drive"), "--map: must be PART=COLUMN"),
        (("--map", "drive=Vd"), "unknown column 'Vd'"),
        (("--scenario", "ch6-mimo"), "has axes, a record has one displacement"),
        (("--rate-khz", "10"), "the times of the file say 50"),
    ],
)
def test_bad_input_is_one_line_and_keeps_nothing(
    arguments: tuple[str, ...], said: str, call: Call, folder: RecordFolder, tmp_path: Path
) -> None:
    found = call("diagnose", foreign(tmp_path / "some.csv", draw(1, samples=3000), 3000), *arguments)
    assert found.exit_code == 2 and said in found.stderr and found.stderr.count("\n") == 1
    assert [*folder.keys()] == []


def test_a_value_that_is_refused_keeps_no_record_and_loses_none(
    call: Call, own: MeasuredRecord, folder: RecordFolder, tmp_path: Path
) -> None:
    file = foreign(tmp_path / "some.csv", draw(1, samples=600), 600)
    wrong = call("replay", file, "--set", "sensor.noise_um=-1")
    assert wrong.exit_code == 2 and "noise_um" in wrong.stderr and [*folder.keys()] == []
    assert call("replay", file).exit_code == 0
    kept = [*folder.keys()]
    assert call("replay", file, "--set", "sensor.noise_um=-1").exit_code == 2 and [*folder.keys()] == kept != []
    assert own.key not in kept


def test_a_file_that_is_not_there_is_one_line(call: Call) -> None:
    found = call("replay", "nowhere.csv")
    assert found.exit_code == 2 and "cannot read nowhere.csv" in found.stderr
