"""The picture of a campaign: which figure it shows first, and whether as a map, as lines, as rows or as a ranking.

The report paints it and the page reads it, so that both show the same.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Literal

import numpy as np
from pydantic import BaseModel, Field

from core.block import FloatArray
from core.errors import unknown
from scenarios.campaign.points import Labels, RowsAxis
from scenarios.campaign.survey import Survey
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import PointTally
from scenarios.report.campaign_figures import by_variation, shown_figures, span_of

MOST_PARTS, MOST_DOTS = 16, 2000
CHANCE = 1.96
"""Standard deviations that 95 % of normal values keep."""

Kind = Literal["rows", "lines", "map", "ranking"]
BY_NUMBERS: tuple[Kind, ...] = ("rows", "lines", "map")


class Part(BaseModel):
    """A figure over a varied quantity, for one combination of the rest: variants, texts of the grid."""

    labels: Labels
    x: list[float] = Field(description="Values across; none for rows")
    y: list[float] = Field(description="Values up; for a map alone")
    mean: list[float]
    std: list[float] = Field(description="Deviation over the seeds")


class Rank(BaseModel):
    """Correlation of a figure with a number that was varied."""

    name: str
    correlation: float = Field(description="Rank correlation by Spearman, -1 to 1")


class CampaignPicture(BaseModel):
    """A figure of a campaign and how it is drawn."""

    kind: Kind = Field(description="By numbers that vary: none, one, two; a ranking if more, or if chance draws them")
    figure: str
    figures: list[str] = Field(description="Figures that a run has: those expected or usual, what varies most first")
    across: str = Field(description="Number on the axis across")
    up: str = Field(description="Number on the axis up of a map")
    low: float = Field(description="Where the axis of the figure begins")
    high: float
    parts: list[Part]
    left_out: int = Field(description="Parts without room")
    ranking: list[Rank] = Field(description="Closest first; for a ranking alone")
    chance: float = Field(description="Correlation that values without relation stay below in 95 % of campaigns")


def surveyed_picture(survey: Survey, figure: str = "", across: str = "") -> CampaignPicture:
    """Choose the picture of a campaign from its files; `campaign_picture` has the rules."""
    known, order = survey.figures, survey.order()
    first = shown_figures(survey.sweep, known)
    read = [name for name in known if name == figure or name in first]
    points = dict(zip(order.tolist(), survey.page(order, read), strict=True))
    return campaign_picture(survey.sweep, points, known, figure, across)


def campaign_picture(
    sweep: Sweep, points: Mapping[int, PointTally], measured: Iterable[str], figure: str = "", across: str = ""
) -> CampaignPicture:
    """Choose the picture of a campaign.

    Parameters
    ----------
    sweep : Sweep
        The campaign.
    points : mapping
        Results by the number of the point, with the figures that may come first, and with the requested figure.
    measured : iterable of str
        All figures that a run has.
    figure, across : str
        The chosen figure in place of the figure that varies most, and the chosen quantity in place of the number with
        the closest correlation.

    Raises
    ------
    InputError
        When there is no such figure or number.
    """
    known = sorted(measured)
    first = by_variation(points.values(), shown_figures(sweep, known))
    figures = [*first, *(name for name in known if name not in first)]
    if figure and figure not in figures:
        raise unknown("figure", figure, figures, "figure")
    figure = figure or next(iter(figures), "")
    grid = [path for path, choices in sweep.head.grid.items() if _is_varied(choices)]
    drawn = [path for axis in sweep.points.varied if isinstance(axis, RowsAxis) for path in axis.numbers]
    kind = "ranking" if drawn or len(grid) > 2 else BY_NUMBERS[len(grid)]
    numbers = [*drawn, *grid]
    there = {number: point for number, point in points.items() if figure in point.metrics}
    values = {name: sweep.points.column(name, np.array([*there], int)) for name in numbers}
    means = np.array([point.metrics[figure].mean for point in there.values()])
    ranking = _ranking(values, means) if kind == "ranking" else []
    if across and across not in numbers:
        raise unknown("number", across, numbers, "across")
    across = across or (ranking[0].name if ranking else next(iter(numbers), ""))
    up = next(name for name in numbers if name != across) if kind == "map" else ""
    shown = [*there.values()][: MOST_DOTS if kind == "ranking" else None]
    parts = _parts(shown, figure, {name: values[name][: len(shown)] for name in (across, up) if name}, kind)
    low, high = span_of(figure, _ends(parts, kind))
    return CampaignPicture(
        kind=kind,
        figure=figure,
        figures=figures,
        across=across,
        up=up,
        low=low,
        high=high,
        parts=parts[:MOST_PARTS],
        left_out=max(0, len(parts) - MOST_PARTS),
        ranking=ranking,
        chance=min(1.0, CHANCE / math.sqrt(max(1, len(means) - 1))),
    )


def _is_varied(choices: Sequence[object]) -> bool:
    """Whether the values of a grid are several numbers."""
    return len(choices) > 1 and all(isinstance(one, int | float) and not isinstance(one, bool) for one in choices)


def _ranking(values: Mapping[str, FloatArray], means: FloatArray) -> list[Rank]:
    """Return Spearman's correlation of means with each number; a constant number has none."""
    found = []
    for name, at in values.items():
        is_flat = len(means) < 3 or np.ptp(at) == 0.0 or np.ptp(means) == 0.0
        correlation = 0.0 if is_flat else float(np.corrcoef(_ranks(at), _ranks(means))[0, 1])
        found.append(Rank(name=name, correlation=correlation))
    return sorted(found, key=lambda one: -abs(one.correlation))


def _ranks(values: FloatArray) -> FloatArray:
    """Return the ranks of numbers; equal numbers share their mean rank (``scipy.stats`` takes two seconds to load)."""
    _, places, counts = np.unique(values, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(counts) - 0.5 * (counts - 1))[places])


def _parts(points: Sequence[PointTally], figure: str, axes: Mapping[str, FloatArray], kind: Kind) -> list[Part]:
    """Divide the points by the labels that are on no axis, each part in the order of its axes."""
    places: list[tuple[float, ...]] = list(zip(*(column.tolist() for column in axes.values()), strict=True))
    parts: dict[str, Part] = {}
    for place, point in sorted(zip(places or [()] * len(points), points, strict=True), key=lambda one: one[0]):
        rest = {} if kind == "ranking" else {name: value for name, value in point.labels.items() if name not in axes}
        part = parts.setdefault(repr(rest), Part(labels=rest, x=[], y=[], mean=[], std=[]))
        for column, value in zip((part.x, part.y), place, strict=False):
            column.append(value)
        part.mean.append(point.metrics[figure].mean)
        part.std.append(point.metrics[figure].std)
    return list(parts.values())


def _ends(parts: Iterable[Part], kind: Kind) -> list[tuple[float, float]]:
    """Return from where to where each figure is drawn: with its band where there is one."""
    has_band = kind in ("rows", "lines")
    pairs = [pair for one in parts for pair in zip(one.mean, one.std, strict=True)]
    return [(mean - std, mean + std) if has_band else (mean, mean) for mean, std in pairs]
