"""A folder for any static host: the scenarios of the library as live pages, with their published runs, and an index."""

from __future__ import annotations

import html
from collections.abc import Callable, Iterable
from itertools import groupby
from pathlib import Path
from typing import Any

from core.errors import InputError
from scenarios.in_a_file.bench_file import BenchFile, bench_file, refusal
from scenarios.in_a_file.exhibit import exhibit
from scenarios.in_a_file.html import SCRIPT, SHARED_POLICY, STYLE, BuiltPage, html_of
from scenarios.in_a_file.track_file import track_file
from scenarios.schema import Scenario

INDEX_PAGE = "index.html"
HEADINGS = {"app": "Appendices", "ch1": "1 Devices", "ch2": "2 Sensing", "ch3": "3 Adaptive control",
            "ch4": "4 Sliding control", "ch5": "5 Fault diagnosis", "ch6": "6 Gyroscopes",
            "gyr": "Gyroscopes beyond the text"}  # fmt: skip
"""Of the index, by the first three letters of an id."""
INDEX = """<!doctype html>
<html lang="en" data-mantine-color-scheme="dark" class="index">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark light">
<title>Live exhibits of CombBench</title>
<link rel="stylesheet" href="{style}">
</head>
<body>
<script>
const light = matchMedia("(prefers-color-scheme: light)");
const dress = () => {{ document.documentElement.dataset.mantineColorScheme = light.matches ? "light" : "dark"; }};
light.addEventListener("change", dress);
dress();
</script>
<header>
<h1>Live exhibits</h1>
<p>Each of these pages is a bench that your browser computes. Inject faults, switch controllers, or compute the
published run anew: the page compares its digest, a hash of every sample, with the published digest.</p>
</header>
{sections}
<footer class="remark">Made by CombBench {version}. {missing}</footer>
</body>
</html>
"""
CARD = """<li><a href="{id}.html">{title}</a> <span class="verdict">{verdict}</span>
<p>{claim}</p><small>{source}</small></li>"""


def write_gallery(
    folder: Path,
    chosen: Iterable[Scenario],
    built: BuiltPage,
    version: str,
    say: Callable[[str], None],
    tracks: Iterable[str] = (),
) -> list[str]:
    """Write the folder, and return the ids of the pages.

    Parameters
    ----------
    folder : Path
        Made if it is not there; files of these names are replaced.
    chosen : iterable of Scenario
        Scenarios; the index names the scenarios that cannot be a file.
    built : BuiltPage
        Script and style sheet, which all pages share.
    version : str
        Of this project.
    say : callable
        Takes a line for each page.
    tracks : iterable of str
        Tracks of the benchmark, which become pages too.
    """
    folder.mkdir(parents=True, exist_ok=True)
    pages: list[tuple[Scenario, dict[str, Any]]] = []
    refused: list[tuple[str, str]] = []

    def write_page(name: str, text: str) -> None:
        _write(folder / f"{name}.html", text)
        say(f"{name}.html, {len(text.encode()) / 1e3:.0f} kB")

    for scenario in chosen:
        if reason := refusal(scenario):
            refused.append((reason, scenario.id))
            continue
        made = exhibit(scenario, bench_file(scenario), None, version, index=INDEX_PAGE)
        write_page(scenario.id, made.text)
        pages.append((scenario, made.record))
    files = {page_of(name): track_file(name) for name in tracks}
    for name, file in files.items():
        write_page(name, html_of(file, None, version, index=INDEX_PAGE))
    if not pages and not files:
        raise InputError("none of these scenarios can be a bench in a file", "--gallery")
    _write(folder / SCRIPT, built.script)
    _write(folder / STYLE, built.style)
    _write(folder / INDEX_PAGE, _index(pages, files, refused, version))
    return [*(scenario.id for scenario, _ in pages), *files]


def page_of(track: str) -> str:
    """Return the name of the page of a track of the benchmark."""
    return f"benchmark-{track.replace('_', '-')}"


def _index(
    pages: list[tuple[Scenario, dict[str, Any]]],
    files: dict[str, BenchFile],
    refused: list[tuple[str, str]],
    version: str,
) -> str:
    sections = []
    for heading, group in groupby(pages, lambda page: HEADINGS.get(page[0].id[:3], "First looks")):
        cards = "\n".join(_card(scenario, record) for scenario, record in group)
        sections.append(f"<section><h2>{heading}</h2>\n<ul>\n{cards}\n</ul></section>")
    if files:
        cards = "\n".join(_track_card(name, file) for name, file in files.items())
        sections.append(f"<section><h2>Benchmark of fault diagnosis</h2>\n<ul>\n{cards}\n</ul></section>")
    missing = [
        f"Without {', '.join(name for _, name in group)}: {reason}."
        for reason, group in groupby(sorted(refused), lambda one: one[0])
    ]
    return INDEX.format(
        policy=SHARED_POLICY,
        style=STYLE,
        sections="\n".join(sections),
        version=html.escape(version),
        missing=html.escape(" ".join(missing)),
    )


def _card(scenario: Scenario, record: dict[str, Any]) -> str:
    head = scenario.head
    words = {"title": head.title or scenario.id, "claim": head.claim or head.summary, "source": head.source}
    return CARD.format(id=scenario.id, verdict=record["verdict"], **{k: html.escape(one) for k, one in words.items()})


def _track_card(name: str, file: BenchFile) -> str:
    rows = len(file.document["track"]["rows"])
    words = {"title": file.document["title"], "claim": file.document["summary"], "source": f"{rows} published rows"}
    return CARD.format(id=name, verdict="", **{k: html.escape(one) for k, one in words.items()})


def _write(file: Path, text: str) -> None:
    file.write_text(text, "utf-8")
