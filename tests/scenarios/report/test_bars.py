"""Charts of campaigns: bars in proportion to the values, which end where the figure does."""

from __future__ import annotations

import re

import pytest

from scenarios.report.axis import Axis
from scenarios.report.metric_name import metric_limits
from scenarios.report.svg import Chart, Series, paint

BAR = re.compile(r"M([\d.]+) ([\d.]+)V([\d.]+)")


def bars(one: Series) -> list[float]:
    """Return the lengths of the bars of a painted chart, px, and whether they are inside of it."""
    drawn = re.findall(r'<path d="((?:M[\d.]+ [\d.]+V[\d.]+)+)"', paint(Chart("t", Axis("x"), Axis("y"), [one])))
    found = [abs(float(a) - float(b)) for path in drawn for _, a, b in BAR.findall(path)]
    return found[-len(one.x) :]


def test_a_deviation_of_a_tenth_of_a_thousandth_is_a_hair() -> None:
    small = bars(Series("", [1.0, 2.0], [0.246992, 0.24698], [3.2e-5, 2.8e-5]))
    large = bars(Series("", [1.0, 2.0], [1.0, 2.0], [0.4, 0.5]))
    assert len(small) == len(large) == 2
    assert max(small) < 5.0 < 20.0 < min(large)


def test_the_bars_of_a_count_end_at_0_and_those_of_a_share_at_1() -> None:
    free, floored = (bars(Series("", [1.0, 2.0], [0.2, 0.5], [0.7, 0.9], limits=ends)) for ends in ((-9, 9), (0, 9)))
    assert free[0] / free[1] == pytest.approx(1.4 / 1.8, rel=0.02)
    assert floored[0] / floored[1] == pytest.approx(0.9 / 1.4, rel=0.02)


def test_the_name_of_a_figure_tells_what_it_cannot_pass() -> None:
    assert metric_limits("diagnosis.kalman.correct_fraction") == (0.0, 1.0)
    assert metric_limits("diagnosis.kalman.false_switches")[0] == metric_limits("control.rms_error_um")[0] == 0.0
    assert metric_limits("rate.scale_error_pct")[0] == -float("inf")
