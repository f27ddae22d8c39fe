"""The one painter of charts as SVG text: lines, lanes and bars over two axes, in colours all people can distinguish.

A chart is described first and painted in the size of its place: large in a report, small on a card of the gallery.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from core.block import FloatArray, IntArray
from scenarios.measure.blocks import loaded
from scenarios.report.axis import Axis, Scale
from scenarios.report.palette import LineStyle, line, style

LETTER = 5.9
"""Width of a letter, px; it decides where a legend starts its next row."""
ROW = 15
NOTHING = Axis("")


@dataclass(frozen=True)
class Series:
    """One line in a band of plus and minus ``spread``, or dots; its look follows from its place unless it has one."""

    name: str
    x: Sequence[float]
    y: Sequence[float]
    spread: Sequence[float] | None = None
    is_stepped: bool = False
    look: LineStyle | None = None
    is_dotted: bool = False


@dataclass(frozen=True)
class EventMark:
    """A moment on the x axis, and the event at it."""

    x: float
    text: str


@dataclass(frozen=True)
class AreaRow:
    """A named row of areas: from, to, look, and whether it is the thin strip of the truth."""

    name: str
    areas: Sequence[tuple[float, float, LineStyle, bool]]


@dataclass(frozen=True)
class Bar:
    """A measured figure with its expectation, each row in a scale of its own."""

    name: str
    value: float
    text: str
    low: float | None
    high: float | None
    holds: bool


@dataclass(frozen=True)
class Chart:
    """Content of a chart: lines over two axes, or lanes over the x axis, or bars."""

    title: str
    x: Axis = NOTHING
    y: Axis = NOTHING
    series: Sequence[Series] = ()
    marks: Sequence[EventMark] = ()
    lanes: Sequence[AreaRow] = ()
    bars: Sequence[Bar] = ()
    keys: Sequence[tuple[str, LineStyle]] = ()
    """Names of a legend where they differ from the names of the lines."""


@dataclass(frozen=True)
class Size:
    """Width and height of a picture, and whether its title is in it."""

    width: int
    height: int
    has_title: bool = True


REPORT, CARD = Size(460, 300), Size(400, 180, has_title=False)


def thin(of: Callable[..., FloatArray], *columns: FloatArray, most: int = 400) -> tuple[IntArray, list[float]]:
    """Return the smallest and the largest value of each column of a picture, in order, and their samples.

    Parameters
    ----------
    of : callable
        Makes the values from the traces.
    columns : ndarray, shape (n,)
        The traces; if they are short enough, all samples are returned.
    most : int
        Pixels of the width.
    """
    samples = len(columns[0])
    if samples <= 2 * most:
        return np.arange(samples), of(*columns).tolist()
    edges = np.linspace(0, samples, most + 1).astype(np.int64)
    kept: list[int] = []
    values: list[float] = []
    for first, end in itertools.pairwise(edges.tolist()):
        piece = of(*(loaded(column[first:end]) for column in columns))
        chosen = sorted({int(np.argmin(piece)), int(np.argmax(piece))})
        kept += [first + at for at in chosen]
        values += piece[chosen].tolist()
    return np.array(kept), values


def picture_file(chart: Chart, size: Size = CARD) -> str:
    """Return a picture as a file of its own; no background, so that it suits light and dark."""
    return with_style(paint(chart, size))


def with_style(svg: str) -> str:
    """Return a painted chart with its style, as a file needs it."""
    return svg.replace(">", f"><style>{style()}</style>", 1) + "\n"


def paint(chart: Chart, size: Size = REPORT) -> str:
    """Paint a chart; values that are not finite are left out."""
    keys = list(chart.keys) or _keys(chart.series)
    rows = _wrapped(keys, size.width - 20)
    top = 8 + (18 if size.has_title else 0) + ROW * len(rows)
    parts = begun(chart.title, size)
    parts += _legend(rows, top - ROW * len(rows) + 4)
    parts += _bars(chart.bars, size, top) if chart.bars else _field(chart, size, top + 6)
    return "".join([*parts, "</svg>"])


def begun(title: str, size: Size) -> list[str]:
    """Return the beginning of a picture, with its title."""
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size.width} {size.height}" '
        f'width="{size.width}" role="img" aria-label="{escape(title)}">'
    ]
    if size.has_title:
        parts.append(f'<text x="10" y="16" class="title">{escape(title)}</text>')
    return parts


def _field(chart: Chart, size: Size, top: int) -> list[str]:
    """Paint axes, and lines or lanes between them."""
    y = Scale(chart.y, [end for one in chart.series for end in _ends(one)])
    ends = [edge for lane in chart.lanes for first, end, _, _ in lane.areas for edge in (first, end)]
    x = Scale(chart.x, ends or [value for one in chart.series for value in one.x])
    bottom, right = size.height - (38 if x.title else 20), size.width - 14
    rows = [] if chart.lanes else y.ticks((bottom - top) / 34)
    names = [label for _, label in rows] + [lane.name for lane in chart.lanes]
    left = round(12 + (18 if y.title and not chart.lanes else 0) + LETTER * max(map(len, names), default=0))

    def across(value: float) -> float:
        return round(left + x.place(value) * (right - left), 1)

    def down(value: float) -> float:
        return round(bottom - y.place(value) * (bottom - top), 1)

    parts = []
    for value, label in x.ticks((right - left) / 70):
        parts.append(f'<path d="M{across(value)} {top}V{bottom}" class="grid"/>')
        parts.append(f'<text x="{across(value)}" y="{bottom + 15}" class="x">{label}</text>')
    for value, label in rows:
        parts.append(f'<path d="M{left} {down(value)}H{right}" class="grid"/>')
        parts.append(f'<text x="{left - 5}" y="{down(value) + 4}" class="y">{label}</text>')
    for mark in chart.marks:
        if x.low <= mark.x <= x.high:
            upright = f'<path d="M{across(mark.x)} {top}V{bottom}" class="mark"/>'
            parts.append(f"<g>{upright}<title>{escape(mark.text)}</title></g>")
    for number, one in enumerate(chart.series):
        look = one.look or line(number)
        spreads = one.spread or [0.0] * len(one.x)
        points = [
            (across(at), down(value), down(max(value - spread, y.low)), down(min(value + spread, y.high)))
            for at, value, spread in zip(one.x, one.y, spreads, strict=True)
            if math.isfinite(at) and math.isfinite(value)
        ]
        path = "".join(
            (f"H{px}V{py}" if one.is_stepped and at else f"{'L' if at else 'M'}{px} {py}")
            for at, (px, py, _, _) in enumerate(points)
        )
        is_dotted = one.is_dotted or len(points) == 1
        if is_dotted:
            path = "".join(f"M{px} {py}h0" for px, py, _, _ in points)
        if one.spread and len(points) > 1:
            edge = [f"{px} {low}" for px, _, low, _ in points] + [f"{px} {high}" for px, _, _, high in points[::-1]]
            parts.append(f'<path d="M{"L".join(edge)}Z" class="band f{look.slot}"/>')
        kind = "dots" if is_dotted else "line"
        parts.append(f'<g {look.stroke}><path d="{path}" class="{kind}"/><title>{escape(one.name)}</title></g>')
    parts += _lanes(chart.lanes, across, left, top, bottom)
    parts.append(f'<text x="{(left + right) / 2}" y="{size.height - 7}" class="x">{escape(x.title)}</text>')
    if y.title and not chart.lanes:
        middle = (top + bottom) / 2
        parts.append(f'<text transform="translate(12 {middle}) rotate(-90)" class="x">{escape(y.title)}</text>')
    return parts


def _lanes(lanes: Sequence[AreaRow], across: Callable[[float], float], left: int, top: int, bottom: int) -> list[str]:
    """Paint lanes below each other; the strip of the truth is thin and above the verdicts."""
    parts: list[str] = []
    height = (bottom - top) / max(1, len(lanes))
    for number, lane in enumerate(lanes):
        upper = top + number * height
        parts.append(f'<text x="{left - 6}" y="{upper + height / 2 + 4:.1f}" class="y">{escape(lane.name)}</text>')
        for first, end, look, is_truth in lane.areas:
            y, tall = (upper + 3, 4.0) if is_truth else (upper + 9, max(4.0, height - 13))
            box = f'x="{across(first)}" y="{y:.1f}" width="{across(end) - across(first):.1f}" height="{tall:.1f}"'
            parts.append(f"<rect {box} {look.fill}/>")
    return parts


def _bars(bars: Sequence[Bar], size: Size, top: int) -> list[str]:
    """Paint a row for each figure: its name, the expectation as a bar, the measurement as a dot, its number."""
    left, right = round(0.45 * size.width), round(0.83 * size.width)
    height = (size.height - top - 6) / max(1, len(bars))
    parts = []
    for row, bar in enumerate(bars):
        y = round(top + (row + 0.5) * height, 1)
        known = [value for value in (bar.low, bar.high, bar.value) if value is not None and math.isfinite(value)]
        air = 0.25 * (max(known) - min(known)) or 0.5 * abs(known[0]) or 0.5
        first, span = min(known) - air, max(known) - min(known) + 2 * air

        def place(value: float | None, other: float, first: float = first, span: float = span) -> float:
            return round(other if value is None else left + (value - first) / span * (right - left), 1)

        low, high = place(bar.low, left), place(bar.high, right)
        name = bar.name if len(bar.name) <= left / LETTER else bar.name[: int(left / LETTER) - 1] + "…"
        parts.append(f'<text x="{left - 8}" y="{y + 4}" class="y">{escape(name)}</text>')
        parts.append(f'<path d="M{left} {y}H{right}" class="grid"/>')
        parts.append(f'<path d="M{low} {y}H{max(high, low + 2)}" class="area s3" stroke-width="7"/>')
        dot = f'cx="{place(bar.value, left)}" cy="{y}" r="4"'
        parts.append(
            f"<circle {dot} {LineStyle(1 if bar.holds else 5).fill}><title>{escape(bar.name)}</title></circle>"
        )
        parts.append(f'<text x="{right + 8}" y="{y + 4}">{escape(bar.text)}</text>')
    return parts


def _keys(series: Sequence[Series]) -> list[tuple[str, LineStyle]]:
    """Return name and look of every line, where there are several."""
    named = [(one.name, one.look or line(number)) for number, one in enumerate(series) if one.name]
    return named if len(series) > 1 else []


def _wrapped(keys: Sequence[tuple[str, LineStyle]], width: float) -> list[list[tuple[float, str, LineStyle]]]:
    """Put the names of a legend into rows, each with where it begins."""
    rows: list[list[tuple[float, str, LineStyle]]] = []
    at = math.inf
    for name, look in keys:
        wide = 34 + LETTER * len(name) + 10
        if at + wide > width:
            rows.append([])
            at = 10.0
        rows[-1].append((round(at, 1), name, look))
        at += wide
    return rows


def _legend(rows: Sequence[Sequence[tuple[float, str, LineStyle]]], top: float) -> list[str]:
    """Paint the names of the lines."""
    parts = []
    for row, entries in enumerate(rows):
        y = top + ROW * row + 6
        for x, name, look in entries:
            parts.append(f'<g {look.stroke}><path d="M{x} {y}h26" class="line"/></g>')
            parts.append(f'<text x="{x + 31}" y="{y + 4}">{escape(name)}</text>')
    return parts


def _ends(one: Series) -> list[float]:
    """Return all heights of a line and of its band."""
    spreads = one.spread or [0.0] * len(one.y)
    return [end for value, spread in zip(one.y, spreads, strict=True) for end in (value - spread, value + spread)]
