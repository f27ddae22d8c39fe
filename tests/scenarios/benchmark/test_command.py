"""``combbench benchmark``: measures, hands in one file, recomputes it, and refuses bad input in one line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import tomlkit
from typer.testing import CliRunner

from scenarios.benchmark import results, seeds
from scenarios.benchmark.track import tracks
from scenarios.report.benchmark import track_table
from server.cli.main import app

ROOT = Path(__file__).resolve().parents[3]
DEMONSTRATION = ("--seeds", "demonstration")


@pytest.fixture
def call(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    runner = CliRunner()
    return lambda *args: runner.invoke(app, ["benchmark", *map(str, args)])


def test_a_submission_is_one_file_that_anyone_recomputes(call, tmp_path):
    done = call("imm", "--track", "known", *DEMONSTRATION, "--json")
    assert done.exit_code == 0, done.stderr
    document = json.loads(done.stdout)
    assert [row["unit"] for row in document["rows"]] == ["imm"] and len(document["rows"][0]["cases"]) == 3
    assert document["costs"]["imm"]["ns_per_sample"] > 0
    (tmp_path / "imm.json").write_text(done.stdout)
    again = call("--check", "imm.json", *DEMONSTRATION)
    assert again.exit_code == 0 and "1 rows are the same to the bit" in again.stdout
    document["rows"][0]["delay_samples"]["mean"] -= 1.0
    (tmp_path / "better.json").write_text(json.dumps(document))
    better = call("--check", "better.json", *DEMONSTRATION)
    assert better.exit_code == 1 and better.stdout == "imm, known: delay_samples\n"


def test_a_diagnoser_that_cannot_be_scored_is_named_with_the_reason(call):
    done = call("axes_bank", "--track", "drift", *DEMONSTRATION)
    assert done.exit_code == 0 and "axes_bank is not scored in drift: it is for plants with axes" in done.stdout


def test_hidden_seeds_are_measured_once_they_are_the_committed_ones(call, tmp_path, monkeypatch):
    hidden = seeds.SecretSeeds(salt="0f" * 32, cases={name: [f"{n:032x}"] for n, name in enumerate(tracks())})
    (tmp_path / "hidden.toml").write_text(tomlkit.dumps(hidden.model_dump()))
    refused = call("imm", "--track", "known", "--seeds", "hidden.toml")
    assert refused.exit_code == 2 and "is not the list that was committed" in refused.stderr
    monkeypatch.setattr(seeds, "COMMITMENT", hidden.commitment())
    monkeypatch.setitem(seeds.LISTS, "public", (1, 2))
    done = call("imm", "--track", "known", "--seeds", "hidden.toml", "--json")
    row = json.loads(done.stdout)["rows"][0]
    assert [case["seed"] for case in row["cases"]] == hidden.cases["known"]


@pytest.mark.parametrize(
    ("args", "word"),
    [
        (["nobody", *DEMONSTRATION], "UNIT"),
        (["imm", "--track", "nowhere"], "--track"),
        (["imm", "--seeds", "missing.toml"], "--seeds"),
        (["imm", "--seeds", "text.toml"], "--seeds"),
        (["--check", "missing.json"], "--check"),
        (["--check", "text.toml"], "--check: is not JSON"),
        (["--check", "list.json"], "--check"),
        (["--check", "empty.json"], "--check: has no rows"),
        (["--check", "empty.json", *DEMONSTRATION], "--seeds"),
        (["imm", "--check", "empty.json"], "--check"),
    ],
    ids=lambda value: " ".join(value)[:40] if isinstance(value, list) else "",
)
def test_bad_input_is_one_line(call, tmp_path, args, word):
    (tmp_path / "text.toml").write_text("salt")
    (tmp_path / "list.json").write_text("[]")
    empty = results.kept().model_copy(update={"rows": [], "left_out": []})
    (tmp_path / "empty.json").write_text(results.write(empty))
    before = sorted(tmp_path.iterdir())
    done = call(*args)
    assert done.exit_code == 2 and done.stdout == ""
    lines = done.stderr.strip().split("\n")
    assert len(lines) == 1 and lines[0].startswith("combbench: ") and word in lines[0], done.stderr
    assert sorted(tmp_path.iterdir()) == before


def test_the_document_has_the_kept_table():
    document = (ROOT / "docs" / "benchmark.md").read_text()
    assert seeds.COMMITMENT in document
    for name in tracks():
        assert "\n".join(line.rstrip() for line in track_table(results.kept(), name)) in document, name


def test_a_unit_from_a_file_is_measured_and_its_results_hold_its_text(call, tmp_path):
    text = (ROOT / "docs" / "own-units.md").read_text().split("```python\n")[2].partition("```")[0]
    (tmp_path / "leaky.py").write_text(text)
    done = call("--unit", "leaky.py", "--track", "known", *DEMONSTRATION, "--json")
    assert done.exit_code == 0, done.stderr
    document = json.loads(done.stdout)
    assert [row["unit"] for row in document["rows"]] == ["leaky"] and document["own"] == {"leaky": text}
    (tmp_path / "leaky.py").unlink()
    (tmp_path / "leaky.json").write_text(done.stdout)
    again = call("--check", "leaky.json", *DEMONSTRATION)
    assert again.exit_code == 0 and "1 rows are the same to the bit" in again.stdout
    wrong = call("--unit", "leaky.json", *DEMONSTRATION)
    assert wrong.exit_code == 2 and "line 1" in wrong.stderr
