"""Files of a run: a report and a drawing that need nothing else, and a script that repeats the run."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pyarrow.parquet as pq

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.report.axis import Axis
from scenarios.report.keeping import keep
from scenarios.report.svg import Chart, EventMark, Series, paint, thin
from scenarios.report.traces import TraceFile
from scenarios.run import run

SVG = "{http://www.w3.org/2000/svg}"


def kept(scenario: Any, folder: Path) -> tuple[dict[str, Any], Path]:
    stem = folder / "new" / "run"
    with TraceFile(stem.with_suffix(".parquet"), scenario.document) as trace:
        result = run(scenario, taps=True, trace=trace)
        summary = result.summary()
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
    assert not re.search(r"(src|href)=\"|url\(|@import|<script|<link", text)
    assert (
        summary["digest"] in text
        and "the transition from one step to the next is quick" in text
        and "inject added_mass +0.05" in text
    )
    drawings = [ElementTree.fromstring(one) for one in re.findall(r"<svg .*?</svg>", text)]
    names = [one.attrib["aria-label"] for one in drawings]
    assert {"Displacement", "Voltage", "Diagnoser kalman"} <= set(names)
    marked = next(one for one in drawings if one.attrib["aria-label"] == "Diagnoser kalman")
    assert [one.text for one in marked.iter(f"{SVG}title") if "inject" in (one.text or "")] == [
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
    assert values["SEEDS"] == f"{summary['seed']}:{summary['seed']}" and values["DIGEST"] == summary["digest"]


def test_a_spike_of_one_sample_stays_in_the_picture() -> None:
    y = np.sin(np.linspace(0.0, 9.0, 100_000))
    y[54_321] = 7.0
    samples, thinned = thin(np.asarray, y, most=50)
    assert len(samples) <= 100 and max(thinned) == 7.0 and min(thinned) == y.min()
    assert np.all(np.diff(samples) > 0) and samples[int(np.argmax(thinned))] == 54_321
    samples, thinned = thin(np.negative, y[:3], most=50)
    assert samples.tolist() == [0, 1, 2] and thinned == (-y[:3]).tolist()
    marks = [EventMark(0.5, "a < b"), EventMark(9.0, "outside")]
    drawing = paint(Chart("t", Axis("x"), Axis("y"), [Series("one", [0, 1], [0, 1])], marks))
    titles = [one.text for one in ElementTree.fromstring(drawing).iter(f"{SVG}title")]
    assert "a < b" in titles and "outside" not in titles
