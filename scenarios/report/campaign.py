"""The report of a campaign: one HTML file that needs nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from core.format import format_count, format_share, format_spread
from scenarios.campaign.survey import Survey
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import DiagnosisTally, PointTally
from scenarios.report.axis import Axis
from scenarios.report.html import as_toml, page, say
from scenarios.report.metric_name import MetricScale, metric_limits, metric_scale
from scenarios.report.svg import Chart, Series

USUAL = (".correct_fraction", ".mean_delay_samples", ".false_switches", "control.rms_error_um")
MOST_CURVES = 16
MOST_POINTS = 1000
"""Points of the table; of a campaign with more, the curves are made of slices of the axis."""
SHARE = (0.0, 1.0)


def name_of(labels: dict[str, str | float]) -> str:
    """Name a point."""
    parts = []
    for path, value in labels.items():
        scale = _scale(path, [value])
        parts.append(f"{scale.name} {_label(scale, value)}" + (f"\u00a0{scale.unit}" if scale.unit else ""))
    return ", ".join(parts) or "all runs"


def _scale(path: str, values: Iterable[str | float]) -> MetricScale:
    """Return how a number that was varied is shown, named by the end of its path."""
    return metric_scale(path.rsplit(".", 1)[-1], values)


def _label(scale: MetricScale, value: str | float) -> str:
    return value if isinstance(value, str) else say(scale.shown(value))


def surveyed_report(sweep: Sweep, survey: Survey) -> str:
    """Return the report of a campaign of any size: of many points, the first that have runs."""
    order = survey.order()
    if len(sweep.points) <= MOST_POINTS:
        return campaign_report(sweep, survey.page(range(len(sweep.points))))
    return campaign_report(sweep, survey.page(order[:MOST_POINTS]), survey if len(order) > MOST_POINTS else None)


def campaign_report(sweep: Sweep, points: Sequence[PointTally], survey: Survey | None = None) -> str:
    """Return the report of a campaign as one HTML file.

    Parameters
    ----------
    sweep : Sweep
        The campaign.
    points : sequence of PointTally
        Its results, those that are there.
    survey : Survey, optional
        All results, where the points are only some of them.
    """
    head = sweep.base.head
    done = sum(point.runs for point in points) if survey is None else survey.runs()
    measured = {name for point in points for name in point.metrics}
    shown = [entry.metric for entry in head.expect if entry.metric in measured]
    shown += [name for name in sorted(measured) if name.endswith(USUAL) and name not in shown]
    shown = list(dict.fromkeys(shown))
    axes = list(dict.fromkeys(name for point in points for name in point.labels))
    across = {axis: _scale(axis, (point.labels.get(axis, "") for point in points)) for axis in axes}
    up = {name: metric_scale(name, (p.metrics[name].mean for p in points if name in p.metrics)) for name in shown}
    return page(
        "campaign.html",
        sweep.head.title or sweep.head.id,
        scenario=head.title or sweep.base.id,
        progress=f"{say(done)} of {say(len(sweep))} runs, {format_count(len(sweep.points), 'point')} with "
        f"{format_count(len(sweep.seeds), 'seed')} each ({sweep.seeds[0]} to {sweep.seeds[-1]}).",
        head=[
            *(scale.title for scale in across.values()),
            *("runs", "expectations hold", "tripped"),
            *(f"{scale.title} (mean ± std)" for scale in up.values()),
        ],
        points=[
            [
                *(_label(scale, point.labels.get(axis, "")) for axis, scale in across.items()),
                *(point.runs, point.ok, point.tripped),
                *(_mean(point, name, scale) for name, scale in up.items()),
            ]
            for point in points
        ],
        errors=[f"{name_of(point.labels)}: {text}" for point in points for text in point.errors],
        warnings=[f"{name_of(point.labels)}: {text}" for point in points for text in point.warnings],
        left_out=0 if survey is None else len(sweep.points) - len(points),
        trends=_trends(points, axes, shown) if survey is None else _profiles(survey, across, up),
        diagnosers=[
            _diagnoser(name, points) for name in dict.fromkeys(name for point in points for name in point.diagnosis)
        ],
        document=as_toml(sweep.document),
    )


def _mean(point: PointTally, name: str, scale: MetricScale) -> str:
    spread = point.metrics.get(name)
    return "" if spread is None else format_spread(name, scale.shown(spread.mean), scale.shown(spread.std))


def _trends(points: Sequence[PointTally], axes: Sequence[str], shown: Sequence[str]) -> list[Chart]:
    """Draw every figure shown over every number that was varied, one line for each combination of the rest."""
    charts = []
    for axis in axes:
        values = {point.labels.get(axis) for point in points}
        if len(values) < 2 or not all(isinstance(value, int | float) for value in values):
            continue
        groups: dict[str, list[PointTally]] = {}
        others = [name for name in axes if name != axis]
        is_alone = len({name_of({k: p.labels[k] for k in others}) for p in points}) > MOST_CURVES
        for point in sorted(points, key=lambda p: float(p.labels[axis])):
            rest = "" if is_alone else name_of({key: point.labels[key] for key in others})
            groups.setdefault(rest, []).append(point)
        x = _scale(axis, (point.labels[axis] for point in points))
        for name in shown:
            measured = {rest: [point for point in group if name in point.metrics] for rest, group in groups.items()}
            y = metric_scale(name, (p.metrics[name].mean for group in measured.values() for p in group))
            lines = [
                Series(
                    rest,
                    [x.shown(float(point.labels[axis])) for point in group],
                    [y.shown(point.metrics[name].mean) for point in group],
                    [y.shown(point.metrics[name].std) for point in group],
                    limits=metric_limits(name),
                )
                for rest, group in measured.items()
            ]
            charts.append(Chart(y.title, Axis(x.title), Axis("mean ± std"), lines))
    return charts


def _profiles(survey: Survey, across: dict[str, MetricScale], up: dict[str, MetricScale]) -> list[Chart]:
    """Draw every figure shown over every number that was varied, the runs of a slice together."""
    charts = []
    for axis in [axis for axis in across if axis in survey.quantities]:
        for name, y in up.items():
            found = survey.profile(axis, name)
            x = _scale(axis, found.x)
            line = Series(
                "",
                [x.shown(value) for value in found.x],
                [y.shown(value) for value in found.mean],
                [y.shown(value) for value in found.std],
                limits=metric_limits(name),
            )
            charts.append(Chart(y.title, Axis(x.title), Axis("mean ± std of the runs of a slice"), [line]))
    return charts


def _diagnoser(name: str, points: Sequence[PointTally]) -> dict[str, Any]:
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
        total = [max(1, sum(row)) for row in entry.confusion]
        rows = [
            [truth, *(format_share(count / all_of) for count in row), sum(row)]
            for truth, row, all_of in zip(entry.names, entry.confusion, total, strict=True)
        ]
        tables.append({"name": label, "names": list(entry.names), "rows": rows, "missed": entry.missed})
    return {"name": name, "charts": charts, "points": len(entries), "tables": tables}


def _delay_curve(label: str, entry: DiagnosisTally) -> Series:
    """Return the share of changes found within some samples; changes that were never found keep it below one."""
    total = sum(entry.delays.values()) + entry.missed
    x, y, sofar = [0.0], [0.0], 0
    for delay, count in sorted(entry.delays.items()):
        sofar += count
        x.append(float(delay))
        y.append(sofar / total)
    return Series(label, x, y, is_stepped=True)
