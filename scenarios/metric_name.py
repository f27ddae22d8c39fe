"""Names of figures in words, with the unit that the name of a field ends in.

The page has the same rules; ``web/src/testing/cases/metric.json`` holds both to the same names.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from core.format import format_figure, format_spread, plain_scale, round_to

NAMES: dict[str, Any] = json.loads((Path(__file__).parent / "metric_names.json").read_text("utf-8"))
"""Shared with the page: families not said, words for their numbers and for parts of names, units by endings."""


class MetricScale(NamedTuple):
    """Display of figures of one metric next to each other: words, unit, factor to the unit."""

    name: str
    unit: str
    factor: float
    metric: str
    own: str  # the unit that the figures come in

    @property
    def title(self) -> str:
        """Words and unit: "rms error, µm"."""
        return f"{self.name}, {self.unit}" if self.unit else self.name

    def shown(self, value: float) -> float:
        """Return a figure in that unit."""
        return value if self.factor == 1.0 else round_to(value * self.factor, 12)

    def say(self, mean: float, std: float = 0.0) -> str:
        """Write one figure by itself, with its deviation, in the unit and prefix that suit it."""
        return format_spread(self.metric, mean, std, self.own) if std else metric_text(self.metric, mean)


def metric_scale(metric: str, values: Iterable[Any] = ()) -> MetricScale:
    """Return the scale of some figures: in the unit the name ends in, with a prefix where they need one."""
    name, unit = _parts(metric)
    factor, text = plain_scale(unit, [value for value in values if isinstance(value, int | float)])
    return MetricScale(name, text, factor, metric, unit)


def metric_text(metric: str, value: float | None, digits: int = 4) -> str:
    """Write a figure with its unit, by the name of its metric."""
    return format_figure(metric, value, digits, metric_unit(metric))


def metric_unit(metric: str) -> str:
    """Return the unit that a metric comes in."""
    return _parts(metric)[1]


def metric_limits(metric: str) -> tuple[float, float]:
    """Return the limits of a figure: at least 0 for counts, times and sizes, at most 1 for shares."""
    if metric.endswith("_fraction"):
        return 0.0, 1.0
    return (0.0 if set(NAMES["counted"]) & set(re.split("[._]", metric)) else -math.inf), math.inf


def holds_zero(metric: str) -> bool:
    """Whether the zero of a figure means something, as of a count, a delay or an error: its axis shows it."""
    return metric_limits(metric)[0] == 0.0 or bool(set(NAMES["from_zero"]) & set(re.split("[._]", metric)))


def _parts(metric: str) -> tuple[str, str]:
    """Return the words of a metric, and the unit its name ends in."""
    pieces = metric.split(".")
    whose = [pieces[1]] if pieces[0] == "twins" and len(pieces) > 2 else []
    pieces = pieces[2:] if whose else pieces
    number = "{}"
    if len(pieces) > 1 and pieces[0] in NAMES["families"]:
        number = NAMES["numbered"].get(pieces[0], number)
        pieces = pieces[1:]
    unit, said = "", list[str]()
    for piece in pieces:
        if piece.isdigit() and said:  # the number of a step belongs to the counted noun
            said[-1] += f" {number.format(piece)}"
            continue
        words, found = _without_unit(piece)
        unit = found or unit
        said.append(words)
    return ": ".join([*whose, *said]), unit


def _without_unit(piece: str) -> tuple[str, str]:
    """Return the words of a piece, and the unit its longest ending names: V/um before um."""
    parts = piece.split("_")
    start = next((i for i in range(1, len(parts)) if "_".join(parts[i:]) in NAMES["units"]), len(parts))
    words = " ".join(NAMES["words"].get(part, part) for part in parts[:start])
    return words, NAMES["units"].get("_".join(parts[start:]), "")
