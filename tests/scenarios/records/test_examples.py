"""Example records: made again to the bit, and diagnosed as their table states."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from scenarios.library import get
from scenarios.records.diagnosis import diagnose
from scenarios.records.examples import FOLDER, ExampleRecord, examples
from scenarios.records.reading import read_record
from scenarios.records.shelf import RecordFolder
from scripts import make_records
from server.cli.main import app


def diagnosed(one: ExampleRecord, folder: RecordFolder) -> None:
    record = read_record(one.path.read_bytes(), one.path.name).record
    found = diagnose(record, get("first-look"), 0, one.healthy, folder)
    assert found.outcome == one.outcome and one.sentence in found.sentence
    if not one.right:
        return
    assert found.result is not None and record.label is not None
    names = [item.name for item in found.result.board.spec.diagnosers["kalman"].params.hypotheses]
    verdict = np.stack([found.result.signal(f"kalman.probability.{name}") for name in names]).argmax(axis=0)
    said, true = np.array(names)[verdict], np.array(record.hypotheses)[record.label]
    assert (said == true)[one.healthy :].mean() >= one.right


def test_each_file_is_small_and_has_its_statement() -> None:
    files = {path.stem: path.stat().st_size for path in FOLDER.glob("*.csv")}
    assert files.keys() == examples().keys() == make_records.RECORDS.keys()
    assert max(files.values()) < 200_000


@pytest.mark.parametrize("name", ["labelled-faults", "drift"])
def test_a_record_is_diagnosed_as_its_table_states(name: str, folder: RecordFolder) -> None:
    diagnosed(examples()[name], folder)


@pytest.mark.long
@pytest.mark.parametrize("name", examples())
def test_every_record_is_diagnosed_as_its_table_states(name: str, folder: RecordFolder) -> None:
    diagnosed(examples()[name], folder)


def test_a_record_begins_with_the_same_bits_when_it_is_made_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(make_records, "SAMPLES", 200)
    for name, one in examples().items():
        assert one.path.read_text("utf-8").splitlines()[:201] == make_records.lines(name)


@pytest.mark.long
@pytest.mark.parametrize("name", examples())
def test_a_record_is_made_again_to_the_bit(name: str) -> None:
    assert examples()[name].path.read_text("utf-8") == "\n".join(make_records.lines(name)) + "\n"


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.chdir(tmp_path)
    yield tmp_path


def test_an_example_is_diagnosed_by_its_name(folder: RecordFolder, elsewhere: Path) -> None:
    found = CliRunner().invoke(app, ["diagnose", "clipped", "--json"], catch_exceptions=False)
    said = json.loads(found.output)
    assert found.exit_code == 3 and said["calibration"]["samples"] == 2000 and "clipped at 2.2 um" in said["refusal"]
    (elsewhere / "clipped").write_text("a file of this name comes first")
    other = CliRunner().invoke(app, ["diagnose", "clipped"], catch_exceptions=False)
    assert other.exit_code == 2 and "unknown kind of file" in other.stderr
