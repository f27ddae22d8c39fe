"""One speed figure: its median and spread over the repeats, and the target it is held against."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median
from typing import Any

Costs = Mapping[str, Sequence[float]]
"""Results of each repeat, by candidate; all in turn within a repeat."""


def figure(
    name: str,
    values: Sequence[float],
    unit: str,
    *,
    least: float | None = None,
    most: float | None = None,
) -> dict[str, Any]:
    """Return a row of the table, JSON-ready; without a target it is for information.

    Parameters
    ----------
    name, unit : str
        The measured quantity, with its set-up.
    values : sequence of float
        A value for each repeat.
    least, most : float, optional
        The target.
    """
    value, best = median(values), most if least is None else least
    sign = "<=" if least is None else ">="
    reached = best is None or (value <= best if least is None else value >= best)
    words = "information" if best is None else f"{sign} {best:g}"
    return {
        "name": name,
        "value": value,
        "low": min(values),
        "high": max(values),
        "repeats": len(values),
        "unit": unit,
        "target": words,
        "ok": reached,
    }


def ratio(costs: Costs, over: str, under: str) -> list[float]:
    """Return how many times one thing costs another, repeat by repeat."""
    return [a / b for a, b in zip(costs[over], costs[under], strict=True)]


def scaled(costs: Costs, name: str, factor: float) -> list[float]:
    """Return the costs of something in another unit."""
    return [factor * cost for cost in costs[name]]


def per_sample(costs: Costs, name: str, sample_ns: float) -> list[float]:
    """Return how often something fits into the time of a sample."""
    return [sample_ns / cost for cost in costs[name]]
