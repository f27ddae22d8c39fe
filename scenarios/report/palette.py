"""Colours and dashes of lines, as on the page: Okabe and Ito's colours, which all people can tell apart."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

PALETTE: dict[str, Any] = json.loads(Path(__file__).with_suffix(".json").read_text())
"""Shared with the page: colours by scheme, dashes, the order of hypotheses, signals that have a look of their own.

The first colour is neutral; the pale ones are darkened in the light scheme, so that they stay visible on white.
"""
COLOURS: list[str] = PALETTE["colours"]["light"]
DASHES: list[list[int]] = PALETTE["dashes"]


@dataclass(frozen=True)
class Look:
    """Colour and dash of a line."""

    colour: str
    dash: str

    @staticmethod
    def of(slot: int, dash: int) -> Look:
        """Return the look of a place in the palette."""
        return Look(COLOURS[slot], " ".join(map(str, DASHES[dash % len(DASHES)])))


def line(number: int) -> Look:
    """Return the look of a line by its place among others."""
    return Look.of(1 + number % (len(COLOURS) - 1), number)


def hypothesis(index: int) -> Look:
    """Return the look of a hypothesis by its place in the list."""
    order = PALETTE["hypotheses"]
    return Look.of(order[index % len(order)], index // len(order))


def signal(name: str, number: int) -> Look:
    """Return the look of a signal: its own, or that of its place among others."""
    known = PALETTE["signals"].get(name)
    return Look.of(*known) if known else line(number)
