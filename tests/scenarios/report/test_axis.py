"""Axes and names of figures as the page has them, from its own tables; and what only reports need."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from core.format import labels_on, unit_scale
from scenarios.metric_name import metric_scale
from scenarios.report.axis import Axis, Scale, decade_ticks, linear_ticks, time_scale

SHARED = Path("web/src/testing/cases")
CASES: dict[str, Any] = json.loads((SHARED / "axis.json").read_text("utf-8"))


def test_ticks_are_those_of_the_page() -> None:
    for low, high, count, ticks in CASES["linear"]:
        assert linear_ticks(low, high, count) == ticks
    for low, high, ticks in CASES["decade"]:
        assert decade_ticks(low, high) == ticks


def test_units_and_labels_are_those_of_the_page() -> None:
    for span, unit, factor in CASES["time"]:
        assert (time_scale(span).unit, time_scale(span).factor) == (unit, factor)
    for unit, size, text, factor in CASES["unit"]:
        scale = unit_scale(unit, size)
        assert (scale.unit, scale.factor) == (text, pytest.approx(factor, rel=1e-12))
    for unit, ticks, labels in CASES["labels"]:
        assert labels_on(unit_scale(unit, max(ticks)), ticks) == labels


def test_figures_have_the_names_of_the_page() -> None:
    for metric, title in json.loads((SHARED / "metric.json").read_text("utf-8")).items():
        assert metric_scale(metric).title == title


def test_an_axis_says_its_unit_once_and_labels_numbers() -> None:
    small = Scale(Axis("displacement", "um"), [0.0, 0.002])
    assert small.title == "displacement, nm"
    assert [label for _, label in small.ticks(4)] == ["0", "1", "2"]
    time = Scale(Axis("time", "ms", (0.0, 4500.0)), [])
    assert time.title == "time, s" and [label for _, label in time.ticks(4)] == ["0", "2", "4"]
    flat = Scale(Axis("share"), [3.0, 3.0])
    assert flat.low < 3.0 < flat.high and flat.title == "share"


def test_a_logarithmic_axis_has_equal_decades_and_few_labels() -> None:
    wide = Scale(Axis("averaging time", "s", is_log=True), [0.001, 100.0])
    assert wide.place(1.0) - wide.place(0.1) == pytest.approx(wide.place(10.0) - wide.place(1.0))
    ticks = wide.ticks(5)
    assert [label for _, label in ticks] == ["0.001", "0.1", "10"]
    assert [label for _, label in Scale(Axis("", "Hz", (1000.0, 10_000.0), is_log=True), []).ticks(5)] == [
        "1",
        "2",
        "5",
        "10",
    ]
