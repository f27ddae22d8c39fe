"""A bench in a folder, and a bench as a file over REST: what is written, what is offered, what is refused."""

from __future__ import annotations

import base64
import gzip
import json
import re
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.in_a_file.bench_file import BenchFile, bench_file
from scenarios.library import get
from scenarios.run import run
from server.api import bench_files, page
from server.cli.folder import answers, write_folder
from server.cli.main import app

LIGHT = "ch6-mimo"
"""A scenario with few blocks."""
INDEX = '<html><head><!-- The root. -->\n<base href="/" /><title>CombBench</title></head></html>'


@pytest.fixture(scope="module")
def made() -> BenchFile:
    """Return the bench of a light scenario."""
    return bench_file(get(LIGHT))


@pytest.fixture
def built(tmp_path: Path) -> Path:
    """Return a folder with a page, as a build leaves it."""
    for name in ("index.html", "assets/page.js", "assets/page.js.gz", "assets/old.ttf", "in-a-file/page.js"):
        file = tmp_path / "dist" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(INDEX if name == "index.html" else name)
    (tmp_path / "dist" / "in-a-file" / "page.css").write_text("a { color: red }")
    return tmp_path / "dist"


def _files(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def test_a_folder_has_the_page_the_bench_and_the_same_bytes_each_time(made: BenchFile, built: Path, tmp_path: Path):
    sizes = [write_folder(get(LIGHT), made, built, tmp_path / name, "1.2.3") for name in ("one", "two")]
    files = _files(tmp_path / "one")
    assert files == _files(tmp_path / "two") and sizes[0] == sum(map(len, files.values()))
    assert sorted(files) == ["assets/page.js", "bench/answers.bin", "bench/code.bin", "bench/pack.bin", "index.html"]
    assert gzip.decompress(files["bench/code.bin"]) == made.code
    page = files["index.html"].decode()
    assert "<base" not in page and "The root" not in page and '<meta name="bench" content="./bench/" />' in page
    assert "default-src 'none'" in page and "http" not in page.replace("http-equiv", "")
    assert "<title>CombBench" not in page


def test_what_is_there_is_not_written_over(made: BenchFile, built: Path, tmp_path: Path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.tex").write_text("x")
    with pytest.raises(InputError, match="is not an empty folder"):
        write_folder(get(LIGHT), made, built, tmp_path / "mine", "1")
    assert [*_files(tmp_path / "mine")] == ["thesis.tex"]
    with pytest.raises(InputError, match="the page has not been built"):
        write_folder(get(LIGHT), made, tmp_path, tmp_path / "new", "1")
    assert not (tmp_path / "new").exists()


def test_the_page_is_offered_what_a_command_of_the_file_does_and_nothing_else(made: BenchFile):
    found = answers(get(LIGHT), made)
    assert json.loads(json.dumps(found, allow_nan=False)) == found
    cards = {(one["family"], one["name"]): one for one in found["catalog"]}
    faults = {name for family, name in cards if family == "faults"}
    assert faults == set(made.document["faults"]) and len(faults) > 3
    assert {"rate", "control"} <= {family for family, _ in cards}
    live = {(key, one["name"]) for key, card in cards.items() for one in card["parameters"] if one["live"]}
    names = {path.rpartition(".")[2] for path in made.document["values"]}
    assert {name for (family, _), name in live if family != "faults"} == names
    for (family, name), card in cards.items():
        if family == "faults":
            (severity,) = card["parameters"]
            grid = made.document["faults"][name]["variants"][0]["dependence"].get("grid")
            assert (severity["name"], severity["grid"]) == ("severity", grid)
    bench = found["bench"]
    assert bench["id"] == LIGHT and bench["view3d"] is None and "created" not in bench
    assert set(bench["controllers"]) == set(made.document["wirings"]["slots"])


def test_a_file_over_rest_is_refused_with_its_reason(live: Any):
    for scenario, status, words in (("none", 404, "none"), ("appB-mit", 422, "it is a study")):
        answer = live.http.get(f"/api/v1/scenarios/{scenario}/file.html")
        assert answer.status_code == status and words in answer.json()["error"]["message"]
    bench = live.bench("ch5-fault-tolerant", paused=True)
    answer = live.http.get(f"/api/v1/benches/{bench['id']}/file.html")
    assert answer.status_code == 422 and "supervisor" in answer.json()["error"]["message"]


def test_rest_and_command_line_give_one_file_with_the_values_and_the_published_run_of_its_document(
    built: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(bench_files, "DIST", built)
    monkeypatch.setattr(page, "DIST", built)
    out = tmp_path / "mine.html"
    changed = {"title": "Mine <b>", "samples": 400}
    assigned = [text for name, value in changed.items() for text in ("--set", f"{name}={value}")]
    done = CliRunner().invoke(app, ["export", LIGHT, "--html", str(out), *assigned])
    assert done.exit_code == 0, done.output
    scenario = with_values(get(LIGHT), changed)
    text = bench_files.html_file(scenario.document)
    assert text == out.read_text() and "<title>Mine &lt;b&gt;</title>" in text
    (pack,) = re.findall(r'id="pack">([^<]*)<', text)
    assert f'"digest":"{run(scenario).digest}"' in gzip.decompress(base64.b64decode(pack)).decode("latin-1")
