"""A run as a small drawing: its motion and its verdicts, or the figures of a study beside their expectations."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from html import escape

import numpy as np

from core.block import FloatArray
from scenarios.report.palette import COLOURS, hypothesis, signal
from scenarios.run import Result

WIDTH, HEIGHT = 240, 120
LANE = 9
COLUMNS = 120
MOST_ROWS = 6
DONE = ("inject", "heal", "switch", "set")
EXPECTED, MEASURED, MISSED = COLOURS[3], COLOURS[1], COLOURS[5]


def thumbnail(result: Result) -> str:
    """Return the drawing of a run as SVG; it has no background, so that it suits light and dark.

    The upper part shows the displacement of the model and of the shuttle, or the true rate and the one that is read.
    The lower part shows, for the first diagnosers, the truth as a thin strip over the verdict. Upright lines mark
    commands. A study has rows instead: the measured figure as a dot, the expectation as a bar.
    """
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
        f'aria-label="{escape(result.scenario.head.title or result.scenario.id)}">'
    ]
    parts += _motion(result) if len(result.outputs) > 1 else _figures(result)
    return "".join([*parts, "</svg>\n"])


def _motion(result: Result) -> list[str]:
    """Draw a trace."""
    names = {signal.name for signal in result.kept}
    diagnosers = [name for name in result.board.spec.diagnosers if f"{name}.winner" in names][:2]
    bottom = HEIGHT - 4 - len(diagnosers) * (LANE + 7)
    width = WIDTH / (len(result.outputs) - 1)
    spec = result.board.spec
    shown = ("rate.rate", f"{spec.active}.rate") if spec.axes else ("model.displacement", "plant.displacement")
    drawn = [result.signal(name) for name in shown]
    peak = max(float(np.nanmax(np.abs(values))) for values in drawn) or 1.0
    middle, scale = (4 + bottom) / 2, (bottom - 4) / 2 / peak
    moments = {entry.tick for entry in result.board.log if entry.kind in DONE} - {0}
    parts = [
        f'<path d="M{tick * width:.1f} 2V{bottom}" stroke="#888" stroke-dasharray="2 2"/>' for tick in sorted(moments)
    ]
    for values, colour in zip(drawn, ("#999", signal(shown[1], 0).colour), strict=True):
        parts.append(_band(values, lambda value: middle - value * scale, colour))
    for number, name in enumerate(diagnosers):
        top = bottom + 3 + number * (LANE + 7)
        parts += _lane(result.signal(f"{name}.truth"), top, 3)
        parts += _lane(result.signal(f"{name}.winner"), top + 4, LANE)
    return parts


def _band(values: FloatArray, place: Callable[[float], float], colour: str) -> str:
    """Draw the area between the smallest and the largest value of each column; a slow trace becomes a line."""
    edges = np.linspace(0, len(values), min(COLUMNS, len(values)) + 1).astype(np.int64)
    upper, lower = [], []
    for x, (first, end) in zip(np.linspace(0.0, WIDTH, len(edges) - 1), itertools.pairwise(edges), strict=True):
        piece = values[first : end + 1]
        piece = piece[np.isfinite(piece)]
        if len(piece):
            upper.append(f"{x:.1f} {place(float(piece.max())):.1f}")
            lower.append(f"{x:.1f} {place(float(piece.min())):.1f}")
    points = " ".join([*upper, *reversed(lower)])
    return (
        f'<path d="M{points}Z" fill="{colour}" fill-opacity=".45" stroke="{colour}" '
        'stroke-width=".8" stroke-linejoin="round"/>'
    )


def _lane(verdict: FloatArray, top: float, height: float) -> list[str]:
    """Draw the hypothesis named at each moment; moments without a verdict stay empty."""
    picked = verdict[np.linspace(0, len(verdict) - 1, COLUMNS).astype(np.int64)]
    edges = [0, *(np.flatnonzero(np.diff(picked)) + 1).tolist(), COLUMNS]
    width = WIDTH / COLUMNS
    return [
        f'<rect x="{first * width:g}" y="{top:g}" width="{(end - first) * width:g}" height="{height:g}" '
        f'fill="{hypothesis(int(picked[first])).colour}"/>'
        for first, end in itertools.pairwise(edges)
        if picked[first] >= 0
    ]


def _figures(result: Result) -> list[str]:
    """Draw each measured figure against its expectation, each in its own scale."""
    parts = []
    for row, entry in enumerate(result.scenario.head.expect[:MOST_ROWS]):
        y = 14 + row * (HEIGHT - 16) / MOST_ROWS
        low, high = entry.bounds()
        measured = result.metrics.get(entry.metric, math.nan)
        known = [value for value in (low, high, measured) if value is not None and math.isfinite(value)]
        if not known:
            continue
        air = 0.25 * (max(known) - min(known)) or 0.5 * abs(known[0]) or 0.5
        first, span = min(known) - air, max(known) - min(known) + 2 * air

        def place(value: float, first: float = first, span: float = span) -> float:
            return 6 + (value - first) / span * (WIDTH - 12)

        left, right = (6 if low is None else place(low)), (WIDTH - 6 if high is None else place(high))
        parts.append(f'<path d="M6 {y}H{WIDTH - 6}" stroke="#888" opacity=".4"/>')
        parts.append(
            f'<path d="M{left:.1f} {y}H{max(right, left + 2):.1f}" stroke="{EXPECTED}" stroke-width="6" opacity=".6"/>'
        )
        if math.isfinite(measured):
            colour = MEASURED if entry.holds(measured) else MISSED
            parts.append(f'<circle cx="{place(measured):.1f}" cy="{y}" r="3.5" fill="{colour}"/>')
    return parts
