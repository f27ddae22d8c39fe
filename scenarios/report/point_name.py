"""Names of the points of a campaign: the values that they differ by, with words and units."""

from __future__ import annotations

from collections.abc import Iterable

from core.format import format_short
from scenarios.campaign.points import Labels
from scenarios.metric_name import MetricScale, metric_scale


def name_of(labels: Labels) -> str:
    """Name a point: "noise 0.6 µm, kind pid"; a variant by its own name."""
    return ", ".join(_named(path, value) for path, value in labels.items()) or "all runs"


def label_scale(path: str, values: Iterable[str | float]) -> MetricScale:
    """Return how a number that was varied is shown, named by the end of its path."""
    return metric_scale(path.rsplit(".", 1)[-1], values)


def label_text(scale: MetricScale, value: str | float) -> str:
    """Return a value that differs between points; a number is cut to its distinctive digits."""
    return value if isinstance(value, str) else format_short(scale.shown(value), "")


def _named(path: str, value: str | float) -> str:
    scale = label_scale(path, [value])
    if path == "variant":
        return label_text(scale, value)
    return f"{scale.name} {label_text(scale, value)}" + (f"\u00a0{scale.unit}" if scale.unit else "")
