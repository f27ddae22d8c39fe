"""Figures of runs: each in the shape for the subject of its scenario, with axes, units and measured values."""

from __future__ import annotations

import re
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.report.axis import Axis
from scenarios.report.figure import figure
from scenarios.report.palette import hypothesis, line
from scenarios.report.svg import AreaRow, Bar, Chart, EventMark, Series, paint, picture_file
from scenarios.run import run

SVG = "{http://www.w3.org/2000/svg}"
CHEAP = {
    "ch1-bode-tolerances": ("frequency, kHz", "magnitude, dB"),
    "appB-mit": ("time, s", "error, µm"),
    "ch2-dual-beam": ("time, ms", "measured less true, nm"),
    "ch3-ffrls-b30": ("time, ms", "error, %"),
    "ch3-stvsc-mass": ("time, ms", "peak error, nm"),
    "ch3-ageing-four-weeks": ("time, ms", "amplitude, µm"),
    "ch4-regulator": ("time, s", "displacement, µm"),
}


def drawn(chart: Chart) -> tuple[Any, list[str]]:
    picture = ElementTree.fromstring(picture_file(chart))
    return picture, [one.text or "" for one in picture.iter(f"{SVG}text")]


@pytest.mark.parametrize("name", CHEAP)
def test_a_figure_has_the_axes_of_its_subject_with_units(name: str) -> None:
    picture, texts = drawn(figure(run(get(name))))
    assert picture.attrib["aria-label"] == get(name).head.title
    assert set(CHEAP[name]) <= set(texts)
    lines = [one for one in picture.iter(f"{SVG}path") if one.attrib.get("class") == "line"]
    assert lines and all(len(texts) > 5 and "nan" not in one.attrib["d"] for one in lines)
    numbers = [text for text in texts if re.fullmatch(r"−?[\d.\u202f]+", text)]
    assert len(numbers) >= 4


def test_lanes_show_the_truth_the_verdict_and_what_was_done() -> None:
    scenario = get("ch5-seven-step")
    chart = figure(run(scenario))
    (lane,) = chart.lanes
    truth = [(first, end, look) for first, end, look, is_truth in lane.areas if is_truth]
    # healthy, then the faults of the scenario, then healthy again, the first as long as the scenario says
    assert [look == hypothesis(0) for _, _, look in truth] == [True, *[False] * 5, True]
    assert truth[0][1] == pytest.approx(2000 * scenario.spec.dt_ms, abs=0.6)
    assert len({mark.x for mark in chart.marks}) == len(scenario.head.events)
    picture, texts = drawn(chart)
    assert {"kalman", "healthy", "mass +5\u00a0%", "time, ms"} <= set(texts)
    assert len(list(picture.iter(f"{SVG}rect"))) == len(lane.areas)


def test_an_allan_deviation_is_logarithmic_and_follows_white_noise() -> None:
    whole = get("gyro-thermal-floor")
    scenario = with_values(whole, {"duration_ms": (whole.head.duration_ms or 0.0) / 6.0})
    chart = figure(run(scenario))
    assert chart.x.is_log and chart.y.is_log and (chart.x.unit, chart.y.unit) == ("s", "deg/h")
    taus, deviations = np.array(chart.series[0].x), np.array(chart.series[0].y)
    assert len(taus) >= 3 and np.allclose(taus[1:] / taus[:-1], 2.0)
    assert deviations[-1] < deviations[0]


def test_a_study_without_curves_shows_what_was_measured_on_what_is_expected() -> None:
    result = run(get("ch1-table-1-1"))
    chart = figure(result)
    expected = result.scenario.head.expect[: len(chart.bars)]
    assert [bar.value for bar in chart.bars] == [result.metrics[entry.metric] for entry in expected]
    picture, texts = drawn(chart)
    assert "spring error, %" in texts and "−29.3" in texts
    dots = list(picture.iter(f"{SVG}circle"))
    areas = [one for one in picture.iter(f"{SVG}path") if one.attrib["class"].startswith("area")]
    for dot, area, bar in zip(dots, areas, chart.bars, strict=True):
        left, right = (float(one) for one in re.findall(r"[MH](-?[\d.]+)", area.attrib["d"]))
        assert (left - 0.1 <= float(dot.attrib["cx"]) <= right + 0.1) == bar.holds


def test_words_are_written_as_they_are() -> None:
    word, points = "<b>&", ([0.0, 1.0], [0.0, 1.0])
    axes: dict[str, Any] = {"x": Axis(word), "y": Axis(word)}
    lines = Chart(word, **axes, series=[Series(word, *points)] * 2, marks=[EventMark(0.5, word)])
    lanes = Chart(word, **axes, lanes=[AreaRow(word, [(0.0, 1.0, line(0), True)])], keys=[(word, line(0))])
    bars = Chart(word, bars=[Bar(word, 1.0, word, 0.5, 1.5, True)])
    # the title; names of lines in the legend, titles of both axes; tips of lines and of the mark
    for chart, texts, tips in ((lines, 1 + 2 + 2, 2 + 1), (lanes, 1 + 1 + 1 + 1, 0), (bars, 1 + 2, 1)):
        picture = ElementTree.fromstring(paint(chart))
        assert picture.attrib["aria-label"] == word
        for tag, expected in (("text", texts), ("title", tips)):
            assert [one.text for one in picture.iter(f"{SVG}{tag}")].count(word) == expected


def test_a_figure_is_the_same_each_time() -> None:
    first, second = (picture_file(figure(run(get("ch3-stvsc-mass")))) for _ in range(2))
    assert first == second and len(first) < 8000


def test_the_rate_that_is_read_is_that_of_the_controller_that_drove() -> None:
    read, true = figure(run(get("gyro-first-look"))).series
    at = dict(zip((round(ms) for ms in read.x), read.y, strict=False))
    assert (read.name, true.name) == ("read", "true")
    assert next(y for ms, y in at.items() if ms > 350) == pytest.approx(100.0, abs=3.0)
    assert next(y for ms, y in at.items() if ms > 500) == pytest.approx(76.0, abs=2.0)
    assert read.y[-1] == pytest.approx(100.0, abs=3.0)
