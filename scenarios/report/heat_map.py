"""The painter of a figure over two numbers as SVG text: a cell for each pair, its colour the figure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from scenarios.report.axis import Axis, Scale
from scenarios.report.palette import ramp
from scenarios.report.svg import LETTER, REPORT, Size, begun

BAR, STEPS = 12, 24
"""Width of the scale of colours, px, and its steps."""
APART = 16
"""Least height between the labels of two rows, px."""


@dataclass(frozen=True)
class Cell:
    """A figure at one pair of numbers, and its text under the pointer."""

    column: int
    row: int
    value: float
    text: str


@dataclass(frozen=True)
class HeatMap:
    """Cells over two titled axes; the labels of columns and rows in ascending order, the range of the colours."""

    title: str
    x: str
    y: str
    columns: Sequence[str]
    rows: Sequence[str]
    cells: Sequence[Cell]
    scale: Axis


def paint_map(shown: HeatMap, size: Size = REPORT) -> str:
    """Paint a map with the scale of its colours; pairs without a figure stay blank."""
    scale = Scale(shown.scale, [cell.value for cell in shown.cells])
    top, bottom = 30, size.height - 38
    ticks = scale.ticks((bottom - top) / 34)
    left = round(32 + LETTER * max(map(len, shown.rows), default=0))
    right = round(size.width - BAR - 22 - LETTER * max(len(label) for _, label in ticks))
    wide, tall = (right - left) / len(shown.columns), (bottom - top) / len(shown.rows)
    parts = begun(shown.title, size)
    for cell in shown.cells:
        x, y = left + cell.column * wide, bottom - (cell.row + 1) * tall
        box = f'x="{x:.1f}" y="{y:.1f}" width="{wide + 0.3:.1f}" height="{tall + 0.3:.1f}"'  # no seams
        fill = ramp(scale.place(cell.value))
        parts.append(f'<rect {box} fill="{fill}"><title>{escape(cell.text)}</title></rect>')
    widest = LETTER * max(map(len, shown.columns)) + 8
    for at in range(0, len(shown.columns), math.ceil(widest / wide)):
        place = f'x="{left + (at + 0.5) * wide:.1f}" y="{bottom + 15}"'
        parts.append(f'<text {place} class="x">{escape(shown.columns[at])}</text>')
    for at in range(0, len(shown.rows), math.ceil(APART / tall)):
        place = f'x="{left - 5}" y="{bottom - (at + 0.5) * tall + 4:.1f}"'
        parts.append(f'<text {place} class="y">{escape(shown.rows[at])}</text>')
    parts.append(f'<text x="{(left + right) / 2}" y="{size.height - 7}" class="x">{escape(shown.x)}</text>')
    turned = f'transform="translate(12 {(top + bottom) / 2}) rotate(-90)"'
    parts.append(f'<text {turned} class="x">{escape(shown.y)}</text>')
    step = (bottom - top) / STEPS
    for at in range(STEPS):
        box = f'x="{right + 10}" y="{bottom - (at + 1) * step:.1f}" width="{BAR}" height="{step + 0.3:.1f}"'
        parts.append(f'<rect {box} fill="{ramp((at + 0.5) / STEPS)}"/>')
    for value, label in ticks:
        y = bottom - scale.place(value) * (bottom - top) + 4
        parts.append(f'<text x="{right + BAR + 14}" y="{y:.1f}">{label}</text>')
    return "".join([*parts, "</svg>"])
