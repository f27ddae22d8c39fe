"""A lab sheet to hand in, as one HTML file: text, answers, points and reasons, small traces; it prints well."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

import numpy as np
from markdown_it import MarkdownIt
from markupsafe import Markup
from mdit_py_plugins.dollarmath import dollarmath_plugin

from core.format import format_short
from scenarios.report.axis import Axis
from scenarios.report.html import page
from scenarios.report.mathml import mathml
from scenarios.report.svg import Chart, Series, paint


def _math(latex: str, options: dict[str, Any]) -> str:
    """Set mathematics."""
    return mathml(latex, is_block=options["display_mode"])


MARKDOWN = (
    MarkdownIt("commonmark", {"html": False})
    .use(dollarmath_plugin, allow_space=False, allow_digits=False, renderer=_math)
    .disable("image")
)
"""HTML in a sheet stays text, and nothing is loaded from elsewhere."""


def markdown(text: str) -> Markup:
    """Return Markdown as HTML."""
    return Markup(MARKDOWN.render(text))


def sheet_html(
    view: Mapping[str, Any], traces: Mapping[str, Any], recordings: Sequence[str], student: str, begun: datetime
) -> str:
    """Return a filled-in sheet.

    Parameters
    ----------
    view : mapping
        The sheet as its student sees it.
    traces : mapping
        Small traces by step.
    recordings : sequence of str
        Those handed in, in words.
    student : str
        Name of the student; empty outside a class.
    begun : datetime
        When the bench was begun.
    """
    return page(
        "sheet.html",
        view["title"],
        sheet=view,
        student=student,
        begun=begun.strftime("%Y-%m-%d %H:%M UTC"),
        markdown=markdown,
        points=_points,
        charts={step: _charts(trace) for step, trace in traces.items()},
        recordings=recordings,
    )


def _points(points: float | None) -> str:
    return "not shown yet" if points is None else format_short(points, "", 4)


def _charts(trace: Mapping[str, Any]) -> list[Markup]:
    """Paint a small trace, signals of one unit in a chart: for each column the lowest and the highest value."""
    units: dict[str, list[Series]] = {}
    for name, signal in trace["signals"].items():
        ends = np.column_stack([signal["low"], signal["high"]]).ravel()
        times = np.linspace(trace["start_ms"], trace["end_ms"], len(ends), endpoint=False)
        units.setdefault(signal["unit"], []).append(Series(name, times.tolist(), ends.tolist()))
    title = "While the conditions held"
    return [Markup(paint(Chart(title, Axis("time", "ms"), Axis("", unit), lines))) for unit, lines in units.items()]
