"""The list of claims is complete: everything it names exists, and every scenario of the text is named."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from core import registry
from scenarios.library import ids, library
from tests.scenarios.test_library_rules import FIGURES, TABLES

OF_THE_TEXT = ("ch1-", "ch2-", "ch3-", "ch4-", "ch5-", "ch6-", "app")
COLUMNS = ["Where", "Subject", "Scenario or page", "Result"]


@pytest.fixture(scope="module")
def rows(root: Path) -> list[list[str]]:
    """Return the cells of every row of the tables, headings included."""
    lines = (root / "docs" / "claims.md").read_text().splitlines()
    tables = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in lines if line.startswith("| ")]
    return [[cell.strip() for cell in row] for row in tables]


def spans(rows: list[list[str]]) -> set[str]:
    return {span for row in rows for cell in row for span in re.findall(r"`([^`]+)`", cell)}


def test_every_row_says_all_four(rows: list[list[str]]) -> None:
    assert rows.count(COLUMNS) == 10
    assert [row for row in rows if len(row) != len(COLUMNS) or not all(row)] == []


def placed(where: str) -> set[str]:
    """Return the numbers a cell names: ``1.1 to 3`` are three of them, ``1.1 and 3`` two, ``2.1`` is one."""
    found: set[str] = set()
    for stem, first, joint, last in re.findall(r"\b([1-6AB](?:\.\d+)*)\.(\d+)\b(?: (to|and) (\d+)\b(?!\.))?", where):
        own = range(int(first), int(last) + 1) if joint == "to" else {first, last or first}
        found |= {f"{stem}.{number}" for number in own}
    return found


def test_every_figure_and_table_of_the_text_has_a_row(rows: list[list[str]]) -> None:
    cells = [row[0] for row in rows if re.search("figure|table", row[0], re.IGNORECASE)]
    named = set().union(*(placed(cell) for cell in cells))
    assert {*FIGURES.split(), *TABLES.split()} - named == set()


def test_what_is_named_is_there(rows: list[list[str]]) -> None:
    """A name is a scenario of the library, or a controller on whose bench a panel shows a figure."""
    assert spans(rows) - set(ids()) - set(registry.blocks("control")) == set()


def test_every_scenario_of_the_text_is_named(rows: list[list[str]]) -> None:
    assert {name for name in ids() if name.startswith(OF_THE_TEXT)} - spans(rows) == set()


def test_where_there_is_none_the_reason_stands_beside_it(rows: list[list[str]]) -> None:
    without = [row for row in rows if row[2] == "none"]
    assert without and all(len(row[3].split()) >= 5 for row in without)
    shown = [row for row in rows if row != COLUMNS and row[2] != "none"]
    assert all("`" in row[2] or re.search(r"page|panel|3D view", row[2]) for row in shown)


def test_every_figure_on_a_bench_has_printed_marks_or_a_reason(root: Path) -> None:
    text = (root / "docs" / "claims.md").read_text().split("## Figures described in numbers")[1]
    reasons = {
        name: words
        for names, words in re.findall(r"^- ((?:`[^`]+`,? ?)+): (.+)$", text, re.MULTILINE)
        for name in re.findall(r"`([^`]+)`", names)
    }
    of_a_figure = {one.id for one in library() if one.study is None and "figure" in one.head.source.lower()}
    drawn = {one.id for one in library() if one.head.printed}
    assert of_a_figure - drawn == set(reasons)
    assert all(len(words.split()) >= 4 for words in reasons.values())
    assert not [one.id for one in library() if one.study is not None and one.head.printed]
