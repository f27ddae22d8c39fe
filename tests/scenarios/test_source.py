"""One rule says what a person means by a scenario: an id, a path, or TOML; from Python and on the command line."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pytest

import combbench as cb
from core.errors import InputError
from scenarios.library import get
from scenarios.source import Source, document_of
from server.cli.terminal import load

TEXT = 'id = "mine"\nsamples = 7\n'
MINE = {"id": "mine", "samples": 7}
LIBRARY = get("first-look").document


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with scenarios under names that mean something else too."""
    monkeypatch.chdir(tmp_path)
    for name in ("bench.toml", "bench", "first-look", "a=b", "UPPER.TOML"):
        (tmp_path / name).write_text(TEXT, "utf-8-sig", newline="\r\n")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "deep.toml").write_text(TEXT)
    (tmp_path / "bytes").write_bytes(b"\xff\xfe")
    return tmp_path


@pytest.mark.parametrize(
    ("source", "document"),
    [
        ("first-look", LIBRARY),
        ("./first-look", MINE),
        (Path("first-look"), MINE),
        ("bench.toml", MINE),
        ("bench", MINE),
        ("a=b", MINE),
        ("UPPER.TOML", MINE),
        ("folder/deep.toml", MINE),
        (Path("folder", "deep.toml"), MINE),
        (TEXT, MINE),
        ("samples = 7", {"samples": 7}),
        (TEXT.encode(), MINE),
        (b"\xef\xbb\xbf" + TEXT.encode(), MINE),
        pytest.param(io.StringIO(TEXT), MINE, id="open text"),
        pytest.param(io.BytesIO(TEXT.encode()), MINE, id="open bytes"),
        (MINE, MINE),
    ],
    ids=str,
)
def test_a_source_means_one_scenario(source: Source, document: dict[str, Any]) -> None:
    assert document_of(source) == document


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("first-lok", "unknown scenario 'first-lok'"),
        ("missing.toml", "cannot read missing.toml: No such file"),
        (Path("missing"), "cannot read missing: No such file"),
        ("folder", "cannot read folder: Is a directory"),
        (Path("folder"), "cannot read folder: Is a directory"),
        ("a = = 1", "malformed TOML"),
        ("x" * 5000, "unknown scenario"),
        ("a\0b", "unknown scenario"),
        ("bytes", "bytes is not UTF-8 text"),
        (b"\xff\xfe", "it is not UTF-8 text"),
    ],
    ids=lambda value: str(value)[:20],
)
def test_a_source_that_is_none_is_refused_in_one_line(source: Source, words: str) -> None:
    with pytest.raises(InputError, match=words) as refused:
        document_of(source)
    assert "\n" not in str(refused.value) and refused.value.field == "scenario"


@pytest.mark.parametrize("source", ["first-look", "./first-look", "bench", "bench.toml", "samples = 7"])
def test_python_and_the_command_line_have_the_same_rule(source: str) -> None:
    assert load(source).document == cb.Scenario.load(source).document


@pytest.mark.parametrize("source", ["first-lok", "missing.toml", "folder", "a = = 1"])
def test_python_and_the_command_line_refuse_in_the_same_words(source: str) -> None:
    with pytest.raises(InputError) as typed:
        load(source)
    with pytest.raises(InputError) as called:
        cb.Scenario.load(source)
    assert (str(typed.value), typed.value.hint) == (str(called.value), called.value.hint)


def test_the_name_of_a_file_is_in_the_error_about_its_text(here: Path) -> None:
    (here / "wrong.toml").write_text("a = = 1")
    with pytest.raises(InputError, match=r"malformed TOML in wrong\.toml"):
        load("wrong.toml")


def test_a_file_may_name_a_unit_that_the_command_line_adds(here: Path) -> None:
    unit = (Path(__file__).resolve().parents[2] / "scenarios" / "starters" / "blank.py").read_text("utf-8")
    (here / "mine.py").write_text(unit)
    (here / "own.toml").write_text('samples = 7\ncontroller.kind = "mine"\n')
    assert load("own.toml", [Path("mine.py")]).spec.active == "mine"
    (here / "wrong.toml").write_text("units = 5\n")
    with pytest.raises(InputError, match="units: must be a table"):
        load("wrong.toml", [Path("mine.py")])
