"""The panels and views in documents, sheets, lectures, tours and the page itself have the names of the page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

FORMER = {"Bench", "Blind diagnosis", "Controllers", "Editor", "Locus", "Parameter sets", "Swept sine"}
"""Former names of panels; the other former names are names of panels or of views now."""
ELSEWHERE = {"Bench", "Controllers", "Editor"}
"""Names of other things of the page too."""
PLACES = ["*.md", "docs/*.md", "scenarios/sheets/*.md", "scenarios/lectures/*.toml", "server/**/*.py"]
PAGE = ["web/src/**/*.ts", "web/src/**/*.tsx"]
LEFT_OUT = {"CHANGELOG.md", "schema.d.ts"}
BEYOND = re.compile(r"Another panel|No panel")


@pytest.fixture(scope="module")
def panels(root: Path) -> dict[str, set[str]]:
    """Titles of panels of the page, each with the titles of its views."""
    owners = (root / "web/src/bench/panel-views.ts").read_text()
    titles = (root / "web/src/app/panels.tsx").read_text()
    of_panels, of_views = titles.split("export const VIEW:")
    named = dict(re.findall(r'^  (\w+): \{\s+title: "([^"]+)"', of_panels, re.M))
    views = dict(re.findall(r'^  (\w+): \{\s+title: "([^"]+)"', of_views, re.M))
    found = re.findall(r"^  (\w+): \[([^\]]+)\],$", owners, re.M)
    return {named[panel]: {views[view] for view in re.findall(r'"(\w+)"', inside)} for panel, inside in found}


def wrong(text: str, panels: dict[str, set[str]]) -> list[str]:
    """Return names in a text that it gives to panels, and no panel has; a view is written Panel › View."""
    words = " ".join(BEYOND.sub("", text).split())
    ways = {*panels, *(f"{panel} › {view}" for panel, views in panels.items() for view in views)}
    lost = (FORMER | set().union(*panels.values())) - set(panels)
    known, gone = ("|".join(sorted(map(re.escape, names), key=len, reverse=True)) for names in (ways, lost))
    after = re.findall(r"\bpanels? (\*{0,2}[A-Z0-9][\w ]*(?: › [\w ]+)?)", words)
    found = [name for name in after if not re.match(rf"\*{{0,2}}(?:{known})\b", name)]
    found += re.findall(rf"(\*\*[A-Z3][\w ›]*\*\* (?=panels?\b)|\b(?:{gone}) (?=panels?\b))", words)
    found += re.findall(rf"\b(?:[Uu]nder|[Ii]n|[Oo]pen) \*{{0,2}}((?:{gone})\b(?! ›))", words)
    bold = re.findall(r"\*\*([A-Z3][\w ›]*)\*\*", words)
    return [
        *(name.strip("* ") for name in found if name.strip("* ") not in ways),
        *(name for name in bold if name in FORMER - ELSEWHERE or (" › " in name and name not in ways)),
    ]


def test_the_page_has_the_panels_that_this_test_reads(panels: dict[str, set[str]]) -> None:
    assert len(panels) == 15
    assert panels["Diagnosis"] == {"Lanes", "Hypotheses", "Noise and memory", "Scoreboard"}


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("Look at the panel **Faults**, then at the panel Log; the panel has more.", []),
        ("the panel\n**Lesson › Hidden fault**", []),
        ("in the panel **Blind diagnosis**", ["Blind diagnosis", "Blind diagnosis"]),
        ("panel Bench under `mrac`", ["Bench under"]),
        ("The **Swept sine** panel", ["Swept sine", "Swept sine"]),
        ("of the Adaptation panel.", ["Adaptation"]),
        ("Under **Controller › Lanes**", ["Controller › Lanes"]),
        ("Under **Environment**, or in Device › Environment.", ["Environment"]),
    ],
)
def test_a_name_of_no_panel_is_found(text: str, names: list[str], panels: dict[str, set[str]]) -> None:
    assert wrong(text, panels) == names


@pytest.mark.parametrize("places", [PLACES, PAGE])
def test_each_panel_that_is_named_is_one_of_the_page(
    places: list[str], root: Path, panels: dict[str, set[str]]
) -> None:
    paths = [path for place in places for path in root.glob(place) if path.name not in LEFT_OUT]
    assert len(paths) > 30
    texts = {path: path.read_text() for path in paths if not re.search(r"\.(test|fixture)\.", path.name)}
    found = {str(path.relative_to(root)): names for path, text in texts.items() if (names := wrong(text, panels))}
    assert found == {}
