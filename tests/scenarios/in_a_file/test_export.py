"""The command that writes a bench into a file, and the lines it says."""

from __future__ import annotations

import base64
import gzip
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from core.errors import InputError
from scenarios.in_a_file.bench_file import BenchFile, bench_file
from scenarios.in_a_file.html import BuiltPage, html_of
from scenarios.library import get
from server.cli.main import app

LIGHT = "ch6-mimo"
"""A scenario with few blocks."""


@pytest.fixture(scope="module")
def made() -> BenchFile:
    """Return the bench of a light scenario."""
    return bench_file(get(LIGHT))


@pytest.fixture
def built(tmp_path: Path) -> Path:
    """Return a folder with a page."""
    (tmp_path / "page.js").write_text("const end = '</script>';")
    (tmp_path / "page.css").write_text("a { color: red }")
    return tmp_path


def test_the_file_has_code_numbers_and_page_in_one_text_that_asks_no_server(made: BenchFile, built: Path):
    text = html_of(made, BuiltPage.of(built), "1.2.3")
    assert len(re.findall("</script>", text)) == 3  # the page's own text does not end its script
    code, pack = re.findall(r'<script type="text/plain" id="\w+">([^<]*)</script>', text)
    assert gzip.decompress(base64.b64decode(code)) == made.code
    assert b'"version":"1.2.3"' in gzip.decompress(base64.b64decode(pack))
    assert "default-src 'none'" in text and "http" not in text.replace("http-equiv", "")


def test_a_page_that_is_not_built_is_named(tmp_path: Path):
    with pytest.raises(InputError, match="the page has not been built"):
        BuiltPage.of(tmp_path)


@pytest.mark.parametrize(
    ("command", "line"),
    [
        (["export", LIGHT], "--html: name one thing to write"),
        (["export", LIGHT, "--html", "x.html", "--scorm", "x.zip"], "--html: name one thing to write"),
        (["export", "--html", "x.html"], "scenario: name the scenario"),
        (["export", LIGHT, "--html", "x.html", "--sheet", "first-look"], "--sheet: goes with --scorm"),
        (["export", LIGHT, "--scorm", "x.zip", "--sheet", "first-look"], "--sheet: goes without a scenario"),
        (["export", "ch9-*", "--gallery", "all"], "scenario: no scenario matches 'ch9-*'"),
        (["export", "ch5-fault-tolerant", "--html", "x.html"], "cannot be a bench in a file: it has a supervisor"),
        (["export", "appB-mit", "--html", "x.html"], "cannot be a bench in a file: it is a study"),
    ],
)
def test_a_refusal_is_one_line_and_writes_nothing(command, line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 2 and line in done.stderr and done.stderr.count("\n") == 1
    assert not [*tmp_path.iterdir()]
