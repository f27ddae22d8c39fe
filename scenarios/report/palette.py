"""Colours and dashes of lines, as on the page: Okabe and Ito's colours, which all people can distinguish."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

PALETTE: dict[str, Any] = json.loads(Path(__file__).with_suffix(".json").read_text())
"""Shared with the page: colours by scheme, dashes, the order of hypotheses, signals that have a look of their own.

The first colour is neutral; the pale ones are darkened in the light scheme, so that they stay visible on white. The
ramp goes from few to many: each step is lighter on dark, darker on light, in every kind of sight.
"""
SLOTS = len(PALETTE["colours"]["light"])
DASHES: list[list[int]] = PALETTE["dashes"]


@dataclass(frozen=True)
class LineStyle:
    """Colour and dash of a line; the colour is a class of the style, which has one for each scheme."""

    slot: int
    dash: str = ""

    @staticmethod
    def of(slot: int, dash: int) -> LineStyle:
        """Return the look of a place in the palette."""
        return LineStyle(slot, " ".join(map(str, DASHES[dash % len(DASHES)])))

    @property
    def stroke(self) -> str:
        """Return the attributes of a line."""
        return f'class="s{self.slot}"' + (f' stroke-dasharray="{self.dash}"' if self.dash else "")

    @property
    def fill(self) -> str:
        """Return the attribute of an area."""
        return f'class="f{self.slot}"'


def style() -> str:
    """Return the style of every chart: colours of the palette in the scheme of the reader."""
    light, dark = (_colours(PALETTE["colours"][scheme]) for scheme in ("light", "dark"))
    return f"{CHART_STYLE}{light}@media (prefers-color-scheme: dark) {{ svg {{ color: #e8ecf1 }} {dark}}}\n"


CHART_STYLE = """
svg { color: #1a1f26 } svg text { font: 11px system-ui, sans-serif; fill: currentColor }
svg .title { font-weight: 600 } svg .x { text-anchor: middle } svg .y { text-anchor: end }
svg .grid { stroke: #8884; fill: none } svg .mark { stroke: #888; stroke-dasharray: 2 2; fill: none }
svg .line { fill: none; stroke-width: 1.7; stroke-linejoin: round } svg .area { opacity: .5 }
svg .band { opacity: .22 } svg .dots { stroke-width: 4.5; stroke-linecap: round; opacity: .75 }
"""


def _colours(colours: list[str]) -> str:
    """Return a class for the stroke and one for the fill of every colour."""
    return "".join(f".s{slot} {{ stroke: {c} }} .f{slot} {{ fill: {c} }} " for slot, c in enumerate(colours))


def line(number: int) -> LineStyle:
    """Return the look of a line by its place among others."""
    return LineStyle.of(1 + number % (SLOTS - 1), number)


def hypothesis(index: int) -> LineStyle:
    """Return the look of a hypothesis by its place in the list."""
    order = PALETTE["hypotheses"]
    return LineStyle.of(order[index % len(order)], index // len(order))


def signal(name: str, number: int) -> LineStyle:
    """Return the look of a signal: its own, or the look of its place among others."""
    known = PALETTE["signals"].get(name)
    return LineStyle.of(*known) if known else line(number)


def ramp(share: float) -> str:
    """Return the colour of a share of a scale from 0 to 1, in the light scheme."""
    stops = [[int(colour[at : at + 2], 16) for at in (1, 3, 5)] for colour in PALETTE["ramp"]["light"]]
    at = min(max(share, 0.0), 1.0) * (len(stops) - 1)
    first = min(int(at), len(stops) - 2)
    mixed = [round(a + (b - a) * (at - first)) for a, b in zip(stops[first], stops[first + 1], strict=True)]
    return "#" + "".join(f"{part:02x}" for part in mixed)
