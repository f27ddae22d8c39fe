"""What is kept of a run: a report and a drawing that need nothing else, and a script that says what was run."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pyarrow.parquet as pq
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.report.keeping import keep
from scenarios.report.palette import hypothesis
from scenarios.report.svg import Mark, Series, chart, thin
from scenarios.report.thumbnail import thumbnail
from scenarios.run import run

SVG = "{http://www.w3.org/2000/svg}"


def kept(scenario: Any, folder: Path) -> tuple[dict[str, Any], Path]:
    result = run(scenario, taps=True)
    summary = result.summary()
    stem = folder / "new" / "run"
    keep(result, summary, [result.seed], stem)
    return summary, stem


def test_a_run_is_kept_in_five_files(tmp_path: Path) -> None:
    scenario = with_values(get("ch5-seven-step"), {"title": "Seven <b>steps</b>", "samples": 4000})
    summary, stem = kept(scenario, tmp_path)
    assert sorted(path.suffix for path in stem.parent.iterdir()) == [".html", ".json", ".parquet", ".py", ".svg"]
    table = pq.read_table(stem.with_suffix(".parquet"))
    np.testing.assert_array_equal(table["plant.displacement"].to_numpy(), run(scenario).signal("plant.displacement"))
    assert json.loads(stem.with_suffix(".json").read_text()) == json.loads(json.dumps(summary))
    text = stem.with_suffix(".html").read_text()
    assert "Seven &lt;b&gt;steps" in text and "<b>steps" not in text
    assert not re.search(r"(src|href)=|url\(|@import|<script|<link", text)
    assert summary["digest"] in text and "every step identified quickly" in text and "inject added_mass +0.05" in text
    drawings = [ElementTree.fromstring(one) for one in re.findall(r"<svg viewBox.*?</svg>", text)]
    names = [one.attrib["aria-label"] for one in drawings]
    assert {"Displacement", "Voltage", "Diagnoser kalman"} <= set(names)
    marked = next(one for one in drawings if one.attrib["aria-label"] == "Diagnoser kalman")
    assert [one.text for one in marked.iter("title") if "inject" in (one.text or "")] == [
        "inject added_mass +0.05",
        "inject added_mass +0.1",
    ]


def test_the_script_holds_the_scenario_as_it_was(tmp_path: Path) -> None:
    scenario = with_values(get("first-look"), {"samples": 300, "title": 'it\'s "quoted" {braces} ü'})
    summary, stem = kept(scenario, tmp_path)
    tree = ast.parse(stem.with_suffix(".py").read_text())
    values = {
        node.targets[0].id: ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id.isupper()
        if node.targets[0].id in ("SCENARIO", "SEEDS", "DIGEST")
    }
    assert values["SCENARIO"] == json.loads(json.dumps(scenario.document))
    assert values["SEEDS"] == [summary["seed"], summary["seed"] + 1] and values["DIGEST"] == summary["digest"]


def test_a_drawing_shows_motion_verdicts_and_what_was_done() -> None:
    drawing = ElementTree.fromstring(thumbnail(run(get("ch5-seven-step"))))
    assert drawing.attrib["aria-label"] == get("ch5-seven-step").head.title
    paths = [one for one in drawing.iter(f"{SVG}path") if "stroke-dasharray" not in one.attrib]
    assert len(paths) == 2  # the model and the shuttle
    # each is the room between its smallest and its largest value: the shuttle's fills the field, give or take a line
    heights = [float(y) for y in re.findall(r"-?[\d.]+", paths[1].attrib["d"])[1::2]]
    assert min(heights) == pytest.approx(4.0, abs=0.2) and max(heights) - min(heights) > 80.0
    dashes = [one for one in drawing.iter(f"{SVG}path") if "stroke-dasharray" in one.attrib]
    assert len(dashes) == len(get("ch5-seven-step").head.events)
    lanes = list(drawing.iter(f"{SVG}rect"))
    truth = [one for one in lanes if one.attrib["height"] == "3"]
    # healthy, then the six steps of the scenario, then healthy: seven strips, the first as long as the scenario says
    assert [one.attrib["fill"] == hypothesis(0).colour for one in truth] == [True, *[False] * 5, True]
    assert float(truth[0].attrib["width"]) == pytest.approx(240 * 2000 / 9000, abs=2.1)


def test_the_drawing_of_a_study_shows_what_was_measured_and_expected() -> None:
    result = run(get("ch1-table-1-1"))
    drawing = ElementTree.fromstring(thumbnail(result))
    expected = result.scenario.head.expect[:6]
    dots = list(drawing.iter(f"{SVG}circle"))
    bars = [one for one in drawing.iter(f"{SVG}path") if one.attrib.get("stroke-width") == "6"]
    assert len(dots) == len(bars) == len(expected)
    for dot, bar, entry in zip(dots, bars, expected, strict=True):
        left, right = (float(one) for one in re.findall(r"[MH](-?[\d.]+)", bar.attrib["d"]))
        inside = left - 0.1 <= float(dot.attrib["cx"]) <= right + 0.1
        assert inside == entry.holds(result.metrics[entry.metric])


def test_a_spike_of_one_sample_stays_in_the_picture() -> None:
    y = np.sin(np.linspace(0.0, 9.0, 100_000))
    y[54_321] = 7.0
    x, thinned = thin(np.arange(100_000.0), y, 50)
    assert len(x) <= 100 and max(thinned) == 7.0 and min(thinned) == y.min()
    assert x == sorted(x) and x[int(np.argmax(thinned))] == 54_321.0
    assert thin(np.arange(3.0), y[:3], 50) == ([0.0, 1.0, 2.0], y[:3].tolist())
    drawing = chart("t", "x", "y", [Series("one", [0, 1], [0, 1])], marks=[Mark(0.5, "a < b"), Mark(9.0, "outside")])
    titles = [one.text for one in ElementTree.fromstring(drawing).iter("title")]
    assert "a < b" in titles and "outside" not in titles
