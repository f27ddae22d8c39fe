"""The report of a campaign: one HTML file that needs nothing else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from markupsafe import Markup

from core.format import format_count, format_share, format_spread
from scenarios.campaign.survey import Survey
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import DiagnosisTally, PointTally
from scenarios.metric_name import MetricScale, metric_scale
from scenarios.narrator.words import diagnosis_words
from scenarios.report.axis import Axis
from scenarios.report.campaign_figures import by_variation, shown_figures
from scenarios.report.campaign_picture import campaign_picture
from scenarios.report.html import as_toml, page, say
from scenarios.report.paint_campaign import paint_campaign
from scenarios.report.point_name import label_scale, label_text, name_of
from scenarios.report.svg import Chart, Series

MOST_CURVES = 16
MOST_PICTURES = 6
"""Figures that are drawn."""
MOST_POINTS = 1000
"""Points of the table; the pictures are of all."""
SHARE = (0.0, 1.0)


def surveyed_report(sweep: Sweep, survey: Survey, name: str = "") -> str:
    """Return the report of a campaign of any size: of many points, the first that have runs."""
    if len(sweep.points) <= MOST_POINTS:
        return campaign_report(sweep, survey.page(range(len(sweep.points))), name)
    order = survey.order()
    rows = survey.page(order, shown_figures(sweep, survey.figures))
    return campaign_report(sweep, survey.page(order[:MOST_POINTS]), name, dict(zip(order.tolist(), rows, strict=True)))


def campaign_report(
    sweep: Sweep, points: Sequence[PointTally], name: str = "", everything: Mapping[int, PointTally] | None = None
) -> str:
    """Return the report of a campaign as one HTML file.

    Parameters
    ----------
    sweep : Sweep
        The campaign.
    points : sequence of PointTally
        Its finished results.
    name : str
        The name that it was given; empty: its title.
    everything : mapping, optional
        The figures of all points by their numbers, where the results are only some of them.
    """
    head = sweep.base.head
    rows = dict(enumerate(points)) if everything is None else everything
    shown = shown_figures(sweep, {name for point in rows.values() for name in point.metrics})
    drawn = by_variation(rows.values(), shown)[:MOST_PICTURES]
    words = diagnosis_words(sweep.base.spec.diagnosers)
    axes = list(dict.fromkeys(name for point in points for name in point.labels))
    across = {axis: label_scale(axis, (point.labels.get(axis, "") for point in points)) for axis in axes}
    up = {name: metric_scale(name, (p.metrics[name].mean for p in points if name in p.metrics)) for name in shown}
    return page(
        "campaign.html",
        name or sweep.head.title or f"Campaign {sweep.head.id}",
        scenario=head.title or sweep.base.id,
        progress=f"{say(sum(point.runs for point in rows.values()))} of {say(len(sweep))} runs, "
        f"{format_count(len(sweep.points), 'point')} with "
        f"{format_count(len(sweep.seeds), 'seed')} each ({sweep.seeds[0]} to {sweep.seeds[-1]}).",
        pictures=[Markup(one) for name in drawn for one in paint_campaign(campaign_picture(sweep, rows, shown, name))],
        head=[
            *(scale.title for scale in across.values()),
            *("runs", "expectations hold", "tripped"),
            *(f"{scale.title} (mean ± std)" for scale in up.values()),
        ],
        points=[
            [
                *(label_text(scale, point.labels.get(axis, "")) for axis, scale in across.items()),
                *(point.runs, point.ok, point.tripped),
                *(_mean(point, name, scale) for name, scale in up.items()),
            ]
            for point in points
        ],
        errors=[f"{name_of(point.labels)}: {text}" for point in points for text in point.errors],
        warnings=[f"{name_of(point.labels)}: {text}" for point in points for text in point.warnings],
        left_out=0 if everything is None else len(sweep.points) - len(points),
        diagnosers=[
            _diagnoser(name, points, words)
            for name in dict.fromkeys(name for point in points for name in point.diagnosis)
        ],
        document=as_toml(sweep.document),
    )


def _mean(point: PointTally, name: str, scale: MetricScale) -> str:
    spread = point.metrics.get(name)
    return "" if spread is None else format_spread(name, scale.shown(spread.mean), scale.shown(spread.std))


def _diagnoser(name: str, points: Sequence[PointTally], words: Mapping[str, str]) -> dict[str, Any]:
    """Return one diagnoser: curves of all points, then confusion point by point."""
    entries = [point for point in points if name in point.diagnosis]
    drawn = [(name_of(point.labels), point.diagnosis[name]) for point in entries[:MOST_CURVES]]
    curves = [
        Series(f"{label} (area {format_share(entry.roc.area)})", entry.roc.false_alarm, entry.roc.detection)
        for label, entry in drawn
        if entry.roc is not None
    ]
    charts = []
    if curves:
        title = "Receiver operating characteristic, sample by sample"
        charts.append(Chart(title, Axis("false alarms", "", SHARE), Axis("detections", "", SHARE), curves))
    delays = [_delay_curve(label, entry) for label, entry in drawn if entry.delays]
    if delays:
        x = Axis("samples", "", (0.0, max(curve.x[-1] for curve in delays)))
        charts.append(Chart("Detection delay", x, Axis("share entries by then", "", SHARE), delays))
    tables = []
    for label, entry in drawn:
        names = [words.get(one, one) for one in entry.names]
        total = [max(1, sum(row)) for row in entry.confusion]
        rows = [
            [truth, *(format_share(count / all_of) for count in row), sum(row)]
            for truth, row, all_of in zip(names, entry.confusion, total, strict=True)
        ]
        tables.append({"name": label, "names": names, "rows": rows, "missed": entry.missed})
    return {"name": words.get(name, name), "charts": charts, "points": len(entries), "tables": tables}


def _delay_curve(label: str, entry: DiagnosisTally) -> Series:
    """Return the share of changes found within some samples; changes that were never found keep it below one."""
    total = sum(entry.delays.values()) + entry.missed
    x, y, sofar = [0.0], [0.0], 0
    for delay, count in sorted(entry.delays.items()):
        sofar += count
        x.append(float(delay))
        y.append(sofar / total)
    return Series(label, x, y, is_stepped=True)
