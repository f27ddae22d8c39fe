"""The folder of live pages: shared parts once, each page with its published run, an index that links to all of them."""

from __future__ import annotations

import base64
import gzip
import json
import re
from pathlib import Path
from typing import Any

import pytest

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.in_a_file import gallery
from scenarios.in_a_file.bench_file import BenchFile
from scenarios.in_a_file.gallery import write_gallery
from scenarios.in_a_file.html import BuiltPage
from scenarios.library import get
from scenarios.run import run

LIGHT, TICKS = "ch6-mimo", 400
SCRIPT = "const shared = 1;"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a gallery of one page and one study."""
    made = tmp_path_factory.mktemp("gallery") / "new"
    chosen = [with_values(get(LIGHT), {"samples": TICKS}), get("appB-mit")]
    said: list[str] = []
    assert write_gallery(made, chosen, BuiltPage(SCRIPT, "a {}"), "1.2.3", said.append) == [LIGHT]
    assert len(said) == 1 and said[0].startswith(f"{LIGHT}.html, ")
    return made


def _document(page: str) -> dict[str, Any]:
    """Return the document of a page, its arrays as places."""
    (pack,) = re.findall(r'id="pack">([^<]*)<', page)
    content = gzip.decompress(base64.b64decode(pack))
    found: dict[str, Any] = json.loads(content[8 : 8 + int.from_bytes(content[:8], "little")])
    return found


def test_pages_share_script_and_style_and_ask_no_other_host(folder: Path):
    assert sorted(one.name for one in folder.iterdir()) == [f"{LIGHT}.html", "index.html", "page.css", "page.js"]
    page = (folder / f"{LIGHT}.html").read_text()
    assert SCRIPT not in page and '<script src="page.js">' in page
    for file in folder.glob("*.html"):
        text = file.read_text()
        assert "default-src 'none'" in text
        assert not re.findall(r'(?:src|href)="(?:[a-z]+:|/)', text)


def test_a_page_has_the_claim_and_the_digest_of_its_run(folder: Path):
    record = _document((folder / f"{LIGHT}.html").read_text())["published"]
    scenario = with_values(get(LIGHT), {"samples": TICKS})
    assert (record["digest"], record["ticks"]) == (run(scenario).digest, TICKS)
    assert record["claim"] == scenario.head.claim
    assert [row["metric"] for row in record["expectations"]] == [entry.metric for entry in scenario.head.expect]


def test_the_index_links_to_every_page_and_names_the_scenarios_without_one(folder: Path):
    text = (folder / "index.html").read_text()
    assert re.findall(r'<li><a href="([^"]+)"', text) == [f"{LIGHT}.html"]
    assert "Without appB-mit: it is a study" in text and "1.2.3" in text


def test_tracks_of_the_benchmark_are_pages_with_a_section_of_their_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    rows = [{"unit": "mmae"}, {"unit": "imm"}]
    file = BenchFile(b"code", {"title": "Drift <1>", "summary": "Has it?", "track": {"rows": rows}}, [])
    monkeypatch.setattr(gallery, "track_file", lambda _name: file)
    assert write_gallery(tmp_path, [], BuiltPage("", ""), "1", print, ["closed_loop"]) == ["benchmark-closed-loop"]
    text = (tmp_path / "index.html").read_text()
    assert "Benchmark of fault diagnosis" in text and "2 published rows" in text and "Drift &lt;1&gt;" in text
    page = _document((tmp_path / "benchmark-closed-loop.html").read_text())
    assert page["track"]["rows"] == rows and page["index"] == "index.html"


def test_a_folder_without_any_page_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match="none of these scenarios"):
        write_gallery(tmp_path / "none", [get("appB-mit")], BuiltPage("", ""), "1", print)
    assert not (tmp_path / "none" / "index.html").exists()
