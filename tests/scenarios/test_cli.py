"""The command line: exit codes, one clear line, nothing written, one JSON object."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from core.registry import block
from scenarios.campaign.single import run_seeds
from scenarios.edit import with_values
from scenarios.library import get, ids
from scenarios.run import build, run
from server.cli import main as cli
from server.cli.main import app
from tests import library_pass

ROOT = Path(__file__).resolve().parents[2]
RUN_KEYS = set("scenario title source seed ticks dt_s elapsed_s digest metrics expectations ok".split())
EXPECT_KEYS = {"metric", "published", "expected", "measured", "ok", "note"}


@pytest.fixture
def call(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    runner = CliRunner()
    return lambda *args: runner.invoke(app, [str(arg) for arg in args], catch_exceptions=False)


def alike(one: Any, other: Any) -> bool:
    """Whether two documents are the same but for the last bits of their numbers, and the times that they took."""
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(alike(one[key], other[key]) for key in one if key != "elapsed_s")
    if isinstance(one, list):
        return len(one) == len(other) and all(map(alike, one, other))
    return bool(one == (pytest.approx(other, rel=1e-9) if isinstance(other, float) else other))


def test_the_version_is_said(call):
    result = call("--version")
    assert (result.exit_code, result.stdout) == (0, f"combbench {version('combbench')}\n")


def test_run_prints_one_json_object(call):
    result = call("run", "ch3-mrac-spring-x2", "--json")
    assert result.exit_code == 0, result.stderr
    found = json.loads(result.stdout)
    assert set(found) >= RUN_KEYS
    assert found["scenario"] == "ch3-mrac-spring-x2" and found["ticks"] == 10_000
    assert found["dt_s"] == pytest.approx(1e-5) and found["seed"] == 1 and found["ok"] is True
    assert len(found["digest"]) == 64 and found["digest"] == run(get("ch3-mrac-spring-x2")).digest
    assert all(isinstance(value, float) and "." in name for name, value in found["metrics"].items())
    for entry in found["expectations"]:
        assert set(entry) >= EXPECT_KEYS and isinstance(entry["ok"], bool)
        assert entry["measured"] == found["metrics"][entry["metric"]]


def test_a_missed_expectation_is_exit_1(call):
    result = call("run", "ch5-seven-step", "--set", "diagnosers.kalman.probability_floor=0", "--json")
    assert result.exit_code == 1
    found = json.loads(result.stdout)
    assert found["ok"] is False
    assert found["metrics"]["diagnosis.kalman.correct_fraction"] == pytest.approx(0.44, abs=0.02)


def test_run_for_people_names_every_figure(call):
    result = call("run", "ch5-seven-step")
    assert result.exit_code == 0
    for word in ("ch5-seven-step", "digest", "diagnosis.kalman.correct_fraction", "ok  "):
        assert word in result.stdout


def test_set_and_seed_change_the_run(call):
    def digest(*args: str) -> str:
        return json.loads(call("run", "ch5-seven-step", "--json", *args).stdout)["digest"]

    plain = digest()
    assert digest("--seed", "1") == plain
    assert len({plain, digest("--seed", "2"), digest("--set", "sensor.noise_um=0.06"), digest("--set", "seed=3")}) == 4
    assert digest("--set", "sensor.noise_um=0.05") == plain


def test_seeds_give_means(call):
    result = call("run", "ch5-seven-step", "--seeds", "1:3", "--json")
    found, expected = json.loads(result.stdout), run_seeds(get("ch5-seven-step"), [1, 2, 3])
    assert result.exit_code == 0 and set(found) >= RUN_KEYS and alike(found, json.loads(json.dumps(expected)))


def test_out_writes_trace_and_summary(call, tmp_path):
    result = call("run", "ch5-seven-step", "--set", "samples=600", "--out", tmp_path / "a" / "b")
    assert result.exit_code in (0, 1)
    files = {path.suffix: path for path in (tmp_path / "a" / "b").iterdir()}
    assert set(files) == {".parquet", ".json", ".html", ".svg", ".py"}
    trace, summary = files[".parquet"], files[".json"]
    table = pq.read_table(trace)
    assert table.num_rows == 600 and {"tick", "time_ms", "plant.displacement", "kalman.nis.m+5"} <= set(
        table.column_names
    )
    expected = json.loads(summary.read_text())
    assert set(expected) >= RUN_KEYS
    metadata = json.loads(table.schema.metadata[b"combbench"])
    assert metadata["seed"] == 1 and metadata["scenario"]["samples"] == 600
    assert np.array_equal(table["tick"].to_numpy(), np.arange(600))


def test_all_signals_are_written_when_they_are_asked_for(call, tmp_path):
    found = {}
    for folder, more in (("usual", []), ("every", ["--all"])):
        asked = ["run", "ch5-seven-step", "--set", "samples=600", *more, "--out", tmp_path / folder, "--json"]
        summary = json.loads(call(*asked).stdout)
        names = pq.read_schema(next((tmp_path / folder).glob("*.parquet"))).names
        found[folder] = names, {key: summary[key] for key in ("digest", "metrics", "warnings")}
    usual, every = found["usual"], found["every"]
    assert usual[1] == every[1]
    assert every[0] == ["tick", "time_ms", *build(get("ch5-seven-step")).signals.names]
    assert {name.split(".")[0] for name in {*every[0]} - {*usual[0]}} >= {"mrac", "pid", "stvsc", "single_beam"}
    assert "open_loop.voltage" in usual[0] and "effects.mass_scale" in usual[0]


FILE = """schema = 1
id = "mine"
samples = 500
[reference]
kind = "sine"
amplitude_v = 1.0
frequency_hz = 100.0
[[expect]]
metric = "control.rms_error_um"
max = 1e-9
"""


def test_a_file_runs_like_a_library_scenario(call, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(FILE)
    good = call("run", path, "--set", "sensor.noise_um=0", "--set", "plant.thermal_noise=false", "--json")
    assert good.exit_code == 0 and json.loads(good.stdout)["scenario"] == "mine"
    assert call("run", path, "--set", "plant.thermal_noise=true").exit_code == 1


BAD = [
    (["run", "nothing"], "scenario"),
    (["run", "ch5-seven-stepp"], "ch5-seven-step"),
    (["run", "missing.toml"], "missing.toml"),
    (["run", "ch5-seven-step", "--set", "sensor.noise_nm=3"], "noise_um"),
    (["run", "ch5-seven-step", "--set", "sensor.noise_um=loud"], "sensor.noise_um"),
    (["run", "ch5-seven-step", "--set", "sensor.noise_um=nan"], "sensor.noise_um"),
    (["run", "ch5-seven-step", "--set", "sensor.noise_um"], "--set"),
    (["run", "ch5-seven-step", "--set", "events.0.severity=99"], "events.0.severity"),
    (["run", "ch5-seven-step", "--set", "events.0.fault=rust"], "events.0"),
    (["run", "ch5-seven-step", "--set", "nonsense=1"], "nonsense"),
    (["run", "ch5-seven-step", "--seeds", "5:1"], "--seeds"),
    (["run", "ch5-seven-step", "--seeds", "1:2", "--seed", "3"], "--seeds"),
    (["run", "ch5-seven-step", "--seeds", "1:2", "--out", "x"], "--out"),
    (["run", "ch5-seven-step", "--seeds", "1:2", "--all"], "--all"),
    (["run", "ch5-seven-step", "--seeds", "\N{SUPERSCRIPT TWO}:3"], "--seeds"),
    (["run", "ch5-seven-step", "--seeds", f"0:{2**53 + 1}"], "--seeds"),
    (["run", "ch5-seven-step", "--seed", "-1"], "seed"),
    (["run", "ch5-seven-step", "--seed", "some"], "--seed"),
    (["run", "ch5-seven-step", "--set", "device.id=[1]"], "device.id"),
    (["run", "ch5-seven-step", "--set", "metrics.tail_share=nan"], "metrics.tail_share"),
    (["run", "ch5-seven-step", "--set", "identifiers.indirect_mrac.kind=excitation"], "identifiers.indirect_mrac"),
    (["run", "ch5-seven-step", "--set", "device" + ".a" * 500 + "=1"], "at most 50 levels"),
    (["run", "ch5-seven-step", "--set", "device=" + "[" * 500], "--set: nested too deeply, at most 50 levels"),
    (["run", "ch5-seven-step", "--set", "device={" + "a." * 500 + "a=1}"], "at most 50 levels"),
    (["run", "ch5-seven-step", "--nonsense"], "--nonsense"),
    (["sweep", "mine.toml", "--workers", "0"], "--workers"),
    (["sweep"], "file"),
    (["nonsense"], "nonsense"),
    (["gallery", "--only", "zz*"], "--only"),
    (["catalog", "animals"], "animals"),
]


def test_bad_input_is_exit_2_and_one_line(call, tmp_path):
    wrong = []
    for args, word in BAD:
        kept = args[0] == "run" and "--out" not in args and "--seeds" not in args
        result = call(*args, *(["--out", "written"] if kept else []))
        lines = result.stderr.strip().split("\n")
        said = len(lines) == 1 and lines[0].startswith("combbench: ") and word in lines[0]
        if not said or (result.exit_code, result.stdout) != (2, "") or list(tmp_path.iterdir()):
            wrong.append((" ".join(args)[:60], result.exit_code, result.stderr[:300]))
    assert wrong == []


def test_a_bad_file_is_exit_2(call, tmp_path):
    path = tmp_path / "bad.toml"
    for text, word in (
        ("schema = ", "malformed"),
        (FILE + "\nvalue = 1\n", "expect.0"),
        ("device" + ".a" * 500 + " = 1", "scenario: nested too deeply, at most 50 levels"),
        ("x = " + "[" * 500, "scenario: nested too deeply, at most 50 levels"),
        (FILE.replace("sine", "sinus"), "reference.kind"),
        (b"\xff\xfe\x00", "bad.toml"),
    ):
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        result = call("run", path, "--json")
        assert (result.exit_code, result.stdout, len(result.stderr.strip().splitlines())) == (2, "", 1), text
        assert word in result.stderr, text


def test_out_that_cannot_be_written_is_exit_2(call, tmp_path):
    (tmp_path / "file").write_text("")
    result = call("run", "ch5-seven-step", "--set", "samples=10", "--out", tmp_path / "file")
    assert result.exit_code == 2 and "--out" in result.stderr


def test_the_gallery_has_a_row_for_each_scenario_that_matches(call):
    result = call("gallery", "--only", "ch3-mrac-*", "--json")
    found = json.loads(result.stdout)
    assert result.exit_code == 0 and all(set(entry) >= RUN_KEYS for entry in found)
    expected = [library_pass.result(name)["gallery"] for name in ids() if name.startswith("ch3-mrac-")]
    assert alike(found, expected)
    people = call("gallery", "--only", "ch3-mrac-spring-*")
    assert people.exit_code == 0 and "ch3-mrac-spring-x2" in people.stdout and "ch3-mrac-mass" not in people.stdout
    lines = people.stdout.splitlines()
    assert max(map(len, lines)) <= 100
    effort = lines.index(next(line for line in lines if "effort_ratio" in line))
    assert lines[effort].endswith(" reproduced")
    assert all(word in lines[effort + 1] for word in ("±\u00a0", "measured ", "open loop ", "published: "))


def test_the_gallery_is_exit_1_when_an_expectation_is_missed(call, monkeypatch):
    missed = with_values(get("ch3-mrac-spring-x2"), {"controller.kind": "open_loop"})
    monkeypatch.setattr("server.cli.main.get", lambda _: missed)
    assert call("gallery", "--only", "ch3-mrac-spring-x2").exit_code == 1


@pytest.mark.long
@pytest.mark.timeout(900)
def test_the_gallery_runs_every_scenario(call):
    result = call("gallery", "--json")
    found = json.loads(result.stdout)
    assert result.exit_code == 0, [entry["scenario"] for entry in found if not entry["ok"]]
    assert [entry["scenario"] for entry in found] == list(ids())


def test_catalog_lists_every_block(call):
    found = json.loads(call("catalog", "--json").stdout)
    assert {entry["family"] for entry in found} >= {
        "reference",
        "plant",
        "sense",
        "control",
        "diagnose",
        "faults",
        "board",
    }
    names = {(entry["family"], entry["name"]) for entry in found}
    assert {("control", "mrac"), ("plant", "linear"), ("faults", "added_mass"), ("diagnose", "mmae")} <= names
    text = call("catalog", "control").stdout
    assert "adaptation_gain" in text and "plant/linear" not in text


def test_catalog_says_where_a_block_is_weak(call, monkeypatch):
    monkeypatch.setattr(block("control", "pid"), "weaknesses", ("It is slow.", "It is blind below 1 kHz."))
    weak = {card["name"]: card["weaknesses"] for card in json.loads(call("catalog", "control", "--json").stdout)}
    assert weak["pid"] == ["It is slow.", "It is blind below 1 kHz."]
    assert weak["open_loop"] == []
    lines = call("catalog", "control").stdout.splitlines()
    assert (
        lines.count("  Known weakness: It is slow.") == lines.count("  Known weakness: It is blind below 1 kHz.") == 1
    )


def program(*args: str, folder: Path, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run the command line in a process of its own."""
    command = [sys.executable, "-m", "server.cli.main", *args]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    given = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    return subprocess.run(command, cwd=folder, env=environment, text=True, check=False, **given)


@pytest.mark.long
def test_the_program_itself_runs_in_any_folder(tmp_path):
    done = program("run", "ch3-mrac-spring-x2", "--json", folder=tmp_path)
    assert done.returncode == 0 and "Traceback" not in done.stderr and json.loads(done.stdout)["ok"]


FULL = "combbench: cannot write to standard output: No space left on device\n"


def test_a_full_disk_behind_the_answer_is_exit_2_and_one_line(tmp_path):
    with Path("/dev/full").open("w") as full:
        done = program("run", "ch3-mrac-spring-x2", folder=tmp_path, stdout=full)
    assert (done.returncode, done.stderr) == (2, FULL)


@pytest.mark.parametrize("args", ["catalog --json", "--help"])
def test_every_answer_that_a_full_disk_refuses_is_exit_2_and_one_line(args, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["combbench", *args.split()])
    with Path("/dev/full").open("w") as full, pytest.raises(SystemExit) as ended:
        monkeypatch.setattr(sys, "stdout", full)
        cli.main()
    assert (ended.value.code, capsys.readouterr().err) == (2, FULL)


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        ("run first-look --set samples=50", 0),
        pytest.param("run nowhere", 2, marks=pytest.mark.long),
        pytest.param("doctor", 0, marks=pytest.mark.long),
        pytest.param("catalog control", 0, marks=pytest.mark.long),
    ],
)
def test_a_closed_standard_output_is_no_failure(arguments: str, code: int) -> None:
    command = f"exec {sys.executable} -m server.cli.main {arguments} >&-"
    ended = subprocess.run(["sh", "-c", command], cwd=ROOT, capture_output=True, text=True, check=False)
    assert ended.returncode == code and "Traceback" not in ended.stderr


def test_a_number_of_thousands_of_digits_is_one_line(call, tmp_path: Path) -> None:
    for name in ("combbench.toml", "mine.toml"):
        (tmp_path / name).write_text(f"max_benches = {'1' * 5000}\n")
    for command in (["run", "mine.toml"], ["sweep", "mine.toml"], ["serve"]):
        ended = call(*command)
        assert (ended.exit_code, len(ended.stderr.strip().splitlines())) == (2, 1), ended.stderr
        assert "4300 digits" in ended.stderr and len(ended.stderr) < 500
