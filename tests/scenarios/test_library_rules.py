"""Every file of the library: its sources are in the text, its words follow from numbers."""

from __future__ import annotations

import re

from scenarios.library import library

SECTIONS = """
    1.1 1.2 1.3 1.4 1.4.1 1.4.2 1.4.3 1.4.4 1.5 1.6 2.1 2.1.1 2.1.2 2.1.3 2.2 2.2.1 2.2.2 2.2.3 2.2.3.1
    3.1 3.1.1 3.1.2 3.1.2.1 3.1.3 3.1.3.1 3.1.3.1.1 3.1.3.1.2 3.1.3.1.3 3.1.3.2
    3.2 3.2.1 3.2.2 3.2.3 3.2.4 3.2.4.1 3.2.4.2 3.2.5 3.2.5.1 3.2.5.2 3.2.6 3.2.6.1 3.3 3.3.1 3.3.2 3.3.3 3.4
    4.1 4.2 4.2.1 4.2.2 4.3 4.3.1 4.4 4.4.1 4.4.2 4.5
    5.1 5.1.1 5.1.2 5.1.3 5.1.4 5.1.5 5.1.6 5.2 5.2.1 5.2.2 5.2.3 5.2.3.1 5.2.3.2 5.2.4 5.2.4.1 5.2.4.2
    5.3 5.3.1 5.3.2 5.3.3 5.3.3.1 5.3.4 5.3.4.1 5.3.4.2 5.4 5.4.1 5.4.2 5.5 5.6
    6.1 6.1.1 6.1.2 6.1.3 6.1.4 6.1.5 6.2 6.3
    A.1 A.2 A.3 A.5 A.6 A.7 A.8 A.9 A.10 A.11 B.1 B.2 B.3 B.4 B.5
"""
FIGURES = """
    1.2.1 1.3.1 1.3.2 1.3.3 1.3.4 1.4.2.1 1.4.2.2 1.4.2.3 1.4.3.1 1.4.4.1
    2.2.1 2.2.3.1 2.3.1.1 2.3.2.1 2.3.2.2 2.3.3.1.1 2.3.3.1.2 2.3.3.1.3
    3.1.2.1.1 3.1.3.1.1 3.1.3.1.2 3.1.3.1.3 3.1.3.1.4 3.1.3.1.5 3.1.3.1.6 3.1.3.2.1 3.1.3.2.2 3.1.3.2.3 3.1.3.2.4
    3.1.3.2.5 3.1.3.2.6 3.1.3.2.7 3.1.3.2.8 3.1.3.2.9 3.2.2.1 3.2.2.2 3.2.6.1 3.2.6.2 3.2.6.1.1 3.2.6.1.2 3.2.6.1.3
    3.2.6.1.4 3.2.6.1.5 3.2.6.1.6 3.2.6.1.7 3.3.2.1 3.3.3.1 3.3.3.2 3.3.3.3 3.3.3.4 3.3.3.5 3.3.3.6 3.3.3.7 3.3.3.8
    3.3.3.9 3.3.3.10 4.3.1.1 4.3.1.2 4.3.1.3 4.3.1.4 4.3.1.5 4.4.1.1 4.4.1.2 4.4.2.1 4.4.2.2
    5.1.3.1 5.1.3.2 5.1.3.3 5.1.5.1 5.2.1.1 5.2.4.1.1 5.2.4.1.2 5.2.4.1.3 5.2.4.1.4 5.2.4.1.5 5.2.4.1.6
    5.2.4.2.1 5.2.4.2.2 5.2.4.2.3 5.3.1.1 5.3.4.1 5.3.4.2 5.3.4.3 5.3.4.2.1 5.3.4.2.2 5.4.2.1 5.4.2.2 5.4.2.3
    6.1.3.1 6.1.3.2 6.1.4.1 6.1.4.2 6.1.4.3 6.1.4.4 6.1.4.5 6.1.5.1 6.1.5.2 6.1.5.3 6.1.5.4 6.3.1.1
    B.1.1 B.1.2 B.2.1 B.2.2 B.3.1
"""
TABLES = "1.1 2.1 5.2.4.1.1 5.2.4.2.1 5.2.4.2.2 5.3.4.2.1 5.5.1"
KNOWN = {"section": SECTIONS.split(), "figure": FIGURES.split(), "table": TABLES.split()}
CITED = re.compile(r"(figure|equation|table)?s? ?\b((?:[1-6]|[AB])(?:\.\d+)+)", re.IGNORECASE)


def cited(source: str) -> list[tuple[str, str]]:
    """Return the citations of a source: numbers after ``figures`` up to the next semicolon are figures, and so on."""
    found = []
    for part in source.split(";"):
        kind = "section"
        for match in CITED.finditer(part):
            kind = (match.group(1) or kind).lower()
            found.append((kind, match.group(2)))
    return found


def test_citations_are_read():
    source = "1.3, Table 1.1, equations 1.3.3 to 1.3.5; 3.2.6 (as drawn), figures 3.3.3.1-3; Micromachines 9(10) 511"
    expected = [
        ("section", "1.3"),
        ("table", "1.1"),
        ("equation", "1.3.3"),
        ("equation", "1.3.5"),
        ("section", "3.2.6"),
    ]
    assert cited(source) == [*expected, ("figure", "3.3.3.1")]


def test_sources_are_in_the_text():
    wrong = []
    for scenario in library():
        places = cited(scenario.head.source)
        for kind, number in places:  # equations are numbered by their section
            known = (number.rpartition(".")[0] if kind == "equation" else number) in KNOWN.get(kind, KNOWN["section"])
            wrong += [] if known else [f"{scenario.id}: no {kind} {number}"]
        published = any(entry.agreeing is not None for entry in scenario.head.expect)
        if published and not any(kind == "section" for kind, _ in places):
            wrong.append(f"{scenario.id} cites no section")
    assert wrong == []


def test_words_are_derived():
    wrong = []
    for scenario in library():
        if scenario.warnings or "verdict" in scenario.document:
            wrong.append(f"{scenario.id}: {scenario.warnings}, or a typed verdict")
        for entry in scenario.head.expect:
            if entry.verdict is not None or bool(entry.published) != (entry.agreeing is not None):
                wrong.append(f"{scenario.id}: {entry.metric} has a typed verdict, or words without numbers")
    assert wrong == []


def test_what_is_published_without_a_number_is_no_window_around_our_figure():
    """Such a range reaches 0, 1 or infinity, or its ends differ by a quarter at least."""
    wrong = []
    for scenario in library():
        for entry in scenario.head.expect:
            if entry.published_value is None and entry.agreeing is not None and not re.search(r"\d", entry.published):
                low, high = entry.agreeing
                is_wide = low <= 0.0 <= high or low <= 1.0 <= high or high >= 1.25 * low
                wrong += [] if is_wide else [f"{scenario.id}: {entry.metric} {entry.published_range}"]
    assert wrong == []


def test_a_claim_beyond_the_text_is_ours():
    beyond = [one for one in library() if one.head.source.startswith("beyond the text") or one.id.startswith("gyro-")]
    assert beyond and [one.id for one in beyond if one.verdict != "ours"] == []


def test_titles_count_what_is_on_the_bench():
    numbers = {
        word: n
        for n, word in enumerate("two three four five six seven eight nine ten eleven twelve thirteen".split(), 2)
    }
    counted = []
    for scenario in library():
        on_the_bench = {
            "controllers": {len(scenario.spec.controllers)},
            "filters": {len(getattr(one.params, "hypotheses", ())) for one in scenario.spec.diagnosers.values()},
        }
        for word, noun in re.findall(rf"({'|'.join(numbers)}) (controllers|filters)", scenario.head.title):
            counted.append((scenario.id, noun))
            assert numbers[word] in on_the_bench[noun], f"{scenario.id} has {on_the_bench[noun]} {noun}"
    assert counted == [("first-look", "filters"), ("first-look", "controllers")]
