"""The site of the documents: its source has every document and every name of the code; its pages keep the policy."""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import re
import subprocess
import sys
import tomllib
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

import pytest
import typer

import combbench
from core.registry import catalog
from scenarios.library import ids
from server.cli.main import app
from server.settings import Settings

WITHOUT_READERS = {"index", "reference/changelog"}
"""Pages for all."""


@pytest.fixture(scope="module")
def pages(root: Path) -> dict[str, str]:
    """The pages of the source by address."""
    sys.path.insert(0, str(root / "scripts"))
    try:
        found, _ = importlib.import_module("manual.site").pages()
    finally:
        sys.path.remove(str(root / "scripts"))
    made: dict[str, str] = found
    return made


def test_every_document_is_a_page(pages: dict[str, str], documents: dict[str, str]) -> None:
    titles = {text.partition("\n")[0] for text in pages.values()}
    assert [name for name, text in documents.items() if text.partition("\n")[0] not in titles] == []
    assert len(pages) > len(documents) + 40


def test_every_page_names_its_readers(pages: dict[str, str]) -> None:
    sections = {address for address in pages if address.count("/") == 1 and address.endswith("/index")}
    without = {name for name, text in pages.items() if not re.search(r"^For \w", text, re.M)} - sections
    assert without == WITHOUT_READERS


def test_every_page_is_in_the_menu_once(pages: dict[str, str]) -> None:
    listed = Counter()
    for name, text in pages.items():
        folder = name.rpartition("/")[0]
        for menu in re.findall(r"```\{toctree\}\n:hidden:\n\n(.*?)\n```", text, re.S):
            listed.update(f"{folder}/{one}".lstrip("/") for one in menu.split("\n"))
    assert listed == Counter({name: 1 for name in pages if name != "index"})


def test_every_public_name_setting_command_and_scenario_is_there(pages: dict[str, str]) -> None:
    python = pages["reference/python"]
    assert [name for name in combbench.__all__ if f"combbench.{name}\n" not in python] == []
    settings = pages["reference/settings"]
    assert [name for name in Settings.model_fields if f"\n| `{name}` |" not in settings] == []
    commands = pages["reference/command-line"]
    assert [one for one in typer.main.get_command(app).commands if f"\n## combbench {one}\n" not in commands] == []
    library = pages["reference/library"]
    assert [name for name in ids() if f"\n| `{name}` |" not in library] == []


def test_every_block_has_its_equations_parameters_and_errata(pages: dict[str, str]) -> None:
    cards = catalog()
    assert len(cards) > 100
    for card in cards:
        text = pages[f"reference/blocks/{card.family}"]
        (entry,) = re.findall(rf"^\(block-{card.family}-{card.name}\)=\n(.*?)(?=^\(block-|\Z)", text, re.S | re.M)
        for equation in card.equations:
            assert f"\n{equation.latex}\n" in entry
            if equation.printed:
                for place in (entry, pages["reference/errata"]):
                    assert f"Printed as {{math}}`{equation.printed}`" in place
        assert [one.name for one in card.parameters if f"\n| `{one.name}` |" not in entry] == []


def test_every_operation_and_schema_of_the_interface_is_there_once(root: Path, pages: dict[str, str]) -> None:
    document = json.loads((root / "web" / "openapi.json").read_text())
    operations = {one["operationId"] for door in document["paths"].values() for one in door.values()}
    rest = "\n".join(text for name, text in pages.items() if name.startswith("reference/rest/"))
    assert Counter(re.findall(r"^\(operation-(\w+)\)=$", rest, re.M)) == Counter(operations)
    schemas = Counter(re.findall(r"^\(schema-(\S+)\)=$", rest, re.M))
    assert {*schemas.values()} == {1} and {*re.findall(r"\(#schema-([^)]+)\)", rest)} <= {*schemas}
    assert {name.lower() for name in document["components"]["schemas"]} == {*schemas}


def test_the_version_is_the_same_everywhere(root: Path) -> None:
    version = tomllib.loads((root / "pyproject.toml").read_text())["project"]["version"]
    assert f"\nversion: {version}\n" in (root / "CITATION.cff").read_text()
    assert re.findall(r"^## (\S+)$", (root / "CHANGELOG.md").read_text(), re.M)[:2] == [version, "0.1.0"]


class Page(HTMLParser):
    """A built page: its anchors, its links, the addresses that it loads, and all that the policy refuses."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loaded: list[str] = []
        self.refused: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.anchors |= {value for name in ("id", "name") if (value := given.get(name))}
        if tag == "a" and (link := given.get("href")):
            self.links.append(link)
        elif address := given.get("src") or (given.get("href") if tag == "link" else None):
            self.loaded.append(address)
        if tag == "style" or (tag == "script" and not given.get("src")):
            self.refused.append(tag)
        self.refused += [name for name, value in attrs if name.startswith("on") or "javascript:" in (value or "")]


@pytest.fixture(scope="module")
def site(root: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Page]:
    """The built pages, by their path."""
    assert importlib.util.find_spec("sphinx"), "the extra docs is missing: make setup"
    folder = tmp_path_factory.mktemp("site") / "built"
    paths = os.pathsep.join(map(str, (root / "scripts", root, *sys.path)))
    command = [sys.executable, "-m", "manual", folder]
    done = subprocess.run(command, cwd=root, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, ""), done.stdout + done.stderr
    found = {file.relative_to(folder).as_posix(): file for file in folder.rglob("*")}
    made: dict[str, Any] = {name: Page(file.read_text()) for name, file in found.items() if name.endswith(".html")}
    return {**dict.fromkeys(found), **made}


@pytest.mark.long
@pytest.mark.timeout(600)
def test_built_pages_keep_the_policy_and_their_links_lead_somewhere(site: dict[str, Page | None]) -> None:
    pages = {name: page for name, page in site.items() if page}
    assert len(pages) > 90
    assert {name: page.refused for name, page in pages.items() if page.refused} == {}
    elsewhere, broken = [], []
    for name, page in pages.items():
        for address in (*page.loaded, *page.links):
            parts = urlsplit(address)
            if parts.scheme or parts.netloc:
                elsewhere += [f"{name}: {address}"] if address in page.loaded else []
                continue
            target = os.path.normpath(Path(name).parent / unquote(parts.path)) if parts.path else name
            heading = unquote(parts.fragment)
            there = site.get(target)
            if target not in site or (heading and there and heading not in there.anchors):
                broken.append(f"{name}: {address}")
    assert elsewhere == [] and broken == []


@pytest.mark.long
@pytest.mark.timeout(600)
def test_every_public_method_has_an_anchor(site: dict[str, Page]) -> None:
    anchors = site["reference/python.html"].anchors
    for name in combbench.__all__:
        value = getattr(combbench, name)
        assert f"combbench.{name}" in anchors
        members = [one for one in vars(value) if not one.startswith("_")] if isinstance(value, type) else []
        documented = [one for one in members if getattr(vars(value)[one], "__doc__", None)]
        assert [one for one in documented if f"combbench.{name}.{one}" not in anchors] == []
