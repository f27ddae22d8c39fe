"""Figures of a campaign: the shown figures, the figure with the largest variation, the range of an axis for it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import PointTally
from scenarios.metric_name import holds_zero, metric_limits

USUAL = (".correct_fraction", ".mean_delay_samples", ".false_switches", "control.rms_error_um")
LEAST_SHARE = 0.01
"""Least deviation within a row that counts, as a share of the size of the figure: less is not seen."""
LEAST_SPAN = 0.02
"""Least range of an axis, as a share of the values: else deviations of a thousandth would fill it."""
AIR = 0.04


def shown_figures(sweep: Sweep, measured: Iterable[str]) -> list[str]:
    """Return the figures to begin with: those the scenario expects and the usual ones, else all."""
    known = sorted(measured)
    expected = [entry.metric for entry in sweep.base.head.expect if entry.metric in known]
    usual = [name for name in known if name.endswith(USUAL)]
    return list(dict.fromkeys([*expected, *usual])) or known


def by_variation(points: Iterable[PointTally], names: Iterable[str]) -> list[str]:
    """Return figures in the order of how much they vary, the most first.

    A figure varies by the standard deviation of its means from row to row, over the deviation within a row: the root of
    the mean square over rows, and at least `LEAST_SHARE` of the mean size. So without seeds the order is by deviation
    over mean size, and a figure that is the same in all rows comes last.
    """
    rows = list(points)

    def variation(name: str) -> float:
        found = [point.metrics[name] for point in rows if name in point.metrics]
        means, stds = np.array([(one.mean, one.std) for one in found]).reshape(-1, 2).T
        between = float(np.std(means)) if len(found) > 1 else 0.0
        if between == 0.0:
            return 0.0
        return between / math.hypot(math.sqrt(np.mean(stds**2)), LEAST_SHARE * np.mean(np.abs(means)))

    return sorted(names, key=variation, reverse=True)


def span_of(figure: str, ends: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Return the range of the axis of a figure.

    It holds zero where zero means something, it ends where the figure must end, such as at 0 for a count, and the
    longest deviation takes at most half of it.

    Parameters
    ----------
    figure : str
        Its metric.
    ends : sequence of (float, float)
        From where to where each value reaches with its deviation.
    """
    least, most = metric_limits(figure)
    kept = [(max(begin, least), min(end, most)) for begin, end in ends] or [(0.0, 0.0), (1.0, 1.0)]
    low, high = min(begin for begin, _ in kept), max(end for _, end in kept)
    if holds_zero(figure):
        low, high = min(low, 0.0), max(high, 0.0)
    longest = max(end - begin for begin, end in kept)
    lacking = max(LEAST_SPAN * max(abs(low), abs(high)), 2.0 * longest) - (high - low)
    if lacking > 0.0:
        low, high = low - 0.5 * lacking, high + 0.5 * lacking
    air = AIR * (high - low) or 0.5
    return max(low - air, least), min(high + air, most)
