"""Charts as SVG text: lines over two axes, in colours and dashes that all people can tell apart."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from core.block import FloatArray
from core.format import tick_labels
from scenarios.report.palette import Look, line

WIDTH, HEIGHT = 460, 300
LEFT, RIGHT, TOP, BOTTOM = 62, 12, 26, 44


@dataclass(frozen=True)
class Series:
    """One line, with bars of plus and minus ``spread``; its look follows from its place unless it has one."""

    name: str
    x: Sequence[float]
    y: Sequence[float]
    spread: Sequence[float] | None = None
    is_stepped: bool = False
    look: Look | None = None


@dataclass(frozen=True)
class Mark:
    """A moment on the x axis, and the event at it."""

    x: float
    text: str


def thin(x: FloatArray, y: FloatArray, columns: int = 400) -> tuple[list[float], list[float]]:
    """Return the smallest and the largest value of each of so many columns, in the order they came.

    Parameters
    ----------
    x, y : ndarray, shape (n,)
        A trace; one that is short enough stays unchanged.
    columns : int
        Pixels of its width.
    """
    if len(y) <= 2 * columns:
        return x.tolist(), y.tolist()
    edges = np.linspace(0, len(y), columns + 1).astype(np.int64)
    kept: list[int] = []
    for first, end in itertools.pairwise(edges):
        piece = y[first:end]
        kept += sorted({first + int(np.argmin(piece)), first + int(np.argmax(piece))})
    return x[kept].tolist(), y[kept].tolist()


def ticks(low: float, high: float, most: int = 6) -> list[float]:
    """Return round values over a range: steps of 1, 2 or 5 times a power of ten."""
    raw = (high - low) / most
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(m * power for m in (1.0, 2.0, 5.0, 10.0) if m * power >= raw * (1.0 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [number * step for number in range(first, math.floor(high / step + 1e-9) + 1)]


def chart(
    title: str,
    x_label: str,
    y_label: str,
    series: Sequence[Series],
    x_range: tuple[float, float] | None = None,
    y_range: tuple[float, float] | None = None,
    marks: Sequence[Mark] = (),
) -> str:
    """Draw lines over two axes with titles; values that are not finite are left out.

    Parameters
    ----------
    title, x_label, y_label : str
        Texts of the chart and its axes, with units.
    series : sequence of Series
        The lines.
    x_range, y_range : (float, float), optional
        Ranges to show instead of those of the lines.
    marks : sequence of Mark
        Moments drawn as upright lines.
    """
    x_low, x_high = x_range or _range([value for one in series for value in one.x])
    y_low, y_high = y_range or _range(_heights(series))

    def place(x: float, y: float) -> tuple[float, float]:
        across = LEFT + (x - x_low) / (x_high - x_low) * (WIDTH - LEFT - RIGHT)
        down = HEIGHT - BOTTOM - (y - y_low) / (y_high - y_low) * (HEIGHT - TOP - BOTTOM)
        return round(across, 1), round(down, 1)

    parts = [
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" role="img" aria-label="{escape(title)}">',
        f'<text x="{LEFT}" y="16" class="title">{escape(title)}</text>',
    ]
    columns, rows = ticks(x_low, x_high), ticks(y_low, y_high)
    for value, label in zip(columns, tick_labels(columns), strict=True):
        x, y = place(value, y_low)
        parts.append(f'<path d="M{x} {TOP}V{y}" class="grid"/><text x="{x}" y="{y + 15}" class="x">{label}</text>')
    for value, label in zip(rows, tick_labels(rows), strict=True):
        x, y = place(x_low, value)
        right = WIDTH - RIGHT
        parts.append(f'<path d="M{x} {y}H{right}" class="grid"/><text x="{x - 5}" y="{y + 4}" class="y">{label}</text>')
    for mark in marks:
        if x_low <= mark.x <= x_high:
            x, _ = place(mark.x, y_low)
            upright = f'<path d="M{x} {TOP}V{HEIGHT - BOTTOM}" class="mark"/>'
            parts.append(f"<g>{upright}<title>{escape(mark.text)}</title></g>")
    for number, one in enumerate(series):
        look = one.look or line(number)
        spreads = one.spread or [0.0] * len(one.x)
        points = [
            (*place(x, y), place(x, y - s)[1], place(x, y + s)[1])
            for x, y, s in zip(one.x, one.y, spreads, strict=True)
            if math.isfinite(x) and math.isfinite(y)
        ]
        path = " ".join(
            (f"H{x} V{y}" if one.is_stepped and at else f"{'L' if at else 'M'}{x} {y}")
            for at, (x, y, _, _) in enumerate(points)
        )
        bars = " ".join(f"M{x} {low}V{high}" for x, _, low, high in points if low != high)
        name = f"<title>{escape(one.name)}</title>"
        parts.append(f'<path d="{path}" fill="none" stroke-width="1.8" {_stroke(look)}>{name}</path>')
        parts.append(f'<path d="{bars}" stroke="{look.colour}" opacity=".6"/>' if bars else "")
    parts.append(f'<text x="{(LEFT + WIDTH) / 2}" y="{HEIGHT - 8}" class="x">{escape(x_label)}</text>')
    middle = (TOP + HEIGHT - BOTTOM) / 2
    parts.append(f'<text transform="translate(14 {middle}) rotate(-90)" class="x">{escape(y_label)}</text></svg>')
    return "".join(parts) + (_legend(series) if len(series) > 1 else "")


def _stroke(look: Look) -> str:
    """Return colour and dash as attributes."""
    return f'stroke="{look.colour}" stroke-dasharray="{look.dash}"'


def _legend(series: Sequence[Series]) -> str:
    """Name the lines."""
    keys = []
    for number, one in enumerate(series):
        key = f'<path d="M0 6H26" stroke-width="2" {_stroke(one.look or line(number))}/>'
        keys.append(f'<span class="key"><svg width="26" height="12">{key}</svg> {escape(one.name)}</span>')
    return f'<div class="keys">{"".join(keys)}</div>'


def _heights(series: Sequence[Series]) -> list[float]:
    """Return all heights that the y axis must show."""
    return [
        value
        for one in series
        for y, spread in zip(one.y, one.spread or [0.0] * len(one.y), strict=True)
        for value in (y - spread, y + spread)
    ]


def _range(values: Sequence[float]) -> tuple[float, float]:
    """Return a range with some air around the values."""
    finite = [value for value in values if math.isfinite(value)] or [0.0, 1.0]
    low, high = float(np.min(finite)), float(np.max(finite))
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        air = 0.5 * abs(high) or 0.5
        return low - air, high + air
    return low - 0.04 * (high - low), high + 0.04 * (high - low)
