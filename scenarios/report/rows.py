"""The painter of named rows over one axis as SVG text: dots with their error bars, or bars from zero."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from scenarios.report.axis import Axis, Scale
from scenarios.report.svg import LETTER, REPORT, Size, begun

TALL = 22
"""Height of a row, px."""


@dataclass(frozen=True)
class ReportRow:
    """A name and its figure, with a deviation or none."""

    name: str
    value: float
    spread: float = 0.0


@dataclass(frozen=True)
class RowChart:
    """Named rows over an axis."""

    title: str
    axis: Axis
    rows: Sequence[ReportRow]
    is_from_zero: bool = False
    """Bars from zero in place of dots."""
    chance: float = 0.0
    """Values nearer to zero are not significant: they are marked."""


def paint_rows(shown: RowChart, width: int = REPORT.width) -> str:
    """Paint rows, the first on top."""
    size = Size(width, 68 + TALL * len(shown.rows))
    scale = Scale(shown.axis, [row.value for row in shown.rows])
    top, bottom, right = 28, size.height - 38, width - 14
    left = min(round(16 + LETTER * max((len(row.name) for row in shown.rows), default=0)), width // 2)

    def across(value: float) -> float:
        return round(left + min(max(scale.place(value), 0.0), 1.0) * (right - left), 1)

    parts = begun(shown.title, size)
    if shown.chance:
        begin, end = across(-shown.chance), across(shown.chance)
        box = f'x="{begin}" y="{top}" width="{end - begin:.1f}" height="{bottom - top}"'
        parts.append(f'<rect {box} class="band f0"/>')
    for value, label in scale.ticks((right - left) / 70):
        parts.append(f'<path d="M{across(value)} {top}V{bottom}" class="grid"/>')
        parts.append(f'<text x="{across(value)}" y="{bottom + 15}" class="x">{label}</text>')
    for number, row in enumerate(shown.rows):
        y = top + (number + 0.5) * TALL
        parts.append(f'<text x="{left - 8}" y="{y + 4}" class="y">{escape(row.name)}</text>')
        if shown.is_from_zero:
            begin, end = sorted((across(0.0), across(row.value)))
            box = f'x="{begin}" y="{y - 6}" width="{end - begin:.1f}" height="12"'
            parts.append(f'<rect {box} class="f1"><title>{escape(row.name)}</title></rect>')
            continue
        low, high = across(row.value - row.spread), across(row.value + row.spread)
        parts.append(f'<path d="M{low} {y}H{high}" class="line s1"/>')
        parts.append(f'<circle cx="{across(row.value)}" cy="{y}" r="4" class="f1"/>')
    parts.append(f'<text x="{(left + right) / 2}" y="{size.height - 7}" class="x">{escape(scale.title)}</text>')
    return "".join([*parts, "</svg>"])
