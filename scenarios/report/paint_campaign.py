"""Paints the picture of a campaign for its report, each part of a map as a map of its own."""

from __future__ import annotations

from scenarios.metric_name import MetricScale, metric_scale
from scenarios.report.axis import Axis
from scenarios.report.campaign_picture import CampaignPicture, Part
from scenarios.report.heat_map import Cell, HeatMap, paint_map
from scenarios.report.point_name import label_scale, label_text, name_of
from scenarios.report.rows import ReportRow, RowChart, paint_rows
from scenarios.report.svg import Chart, Series, paint


def paint_campaign(shown: CampaignPicture) -> list[str]:
    """Return a picture as drawings in SVG; a ranking has a second one, of the runs."""
    scale = metric_scale(shown.figure, [mean for part in shown.parts for mean in part.mean])
    if not shown.parts:
        return []
    if shown.kind == "map":
        return [_map(shown, part, scale) for part in shown.parts]
    figure = Axis(scale.title, "", (scale.shown(shown.low), scale.shown(shown.high)))
    if shown.kind == "rows":
        rows = [
            ReportRow(name_of(part.labels), scale.shown(part.mean[0]), scale.shown(part.std[0])) for part in shown.parts
        ]
        return [paint_rows(RowChart(scale.name, figure, rows))]
    x = label_scale(shown.across, [value for part in shown.parts for value in part.x])
    chart = Chart(
        f"{scale.name} over {x.name}",
        Axis(x.title),
        figure,
        [
            Series(
                name_of(part.labels),
                [x.shown(value) for value in part.x],
                [scale.shown(mean) for mean in part.mean],
                [scale.shown(std) for std in part.std] if shown.kind == "lines" else None,
                is_dotted=shown.kind == "ranking",
            )
            for part in shown.parts
        ],
    )
    return [_ranking(shown, scale), paint(chart)] if shown.kind == "ranking" else [paint(chart)]


def _ranking(shown: CampaignPicture, scale: MetricScale) -> str:
    """Paint the correlation of the figure with each number."""
    rows = [ReportRow(label_scale(one.name, []).name, one.correlation) for one in shown.ranking]
    axis = Axis("rank correlation (grey: by chance)", "", (-1.0, 1.0))
    return paint_rows(RowChart(f"{scale.name}: what it goes with", axis, rows, True, shown.chance))


def _map(shown: CampaignPicture, part: Part, scale: MetricScale) -> str:
    """Paint a part as a map."""
    x, y = label_scale(shown.across, part.x), label_scale(shown.up, part.y)
    columns, rows = sorted(set(part.x)), sorted(set(part.y))
    cells = []
    for across, up, mean, std in zip(part.x, part.y, part.mean, part.std, strict=True):
        where = name_of({shown.across: across, shown.up: up})
        text = f"{where}: {scale.say(mean, std)}"
        cells.append(Cell(columns.index(across), rows.index(up), scale.shown(mean), text))
    return paint_map(
        HeatMap(
            f"{scale.title} over {x.name} and {y.name}" + (f": {name_of(part.labels)}" if len(shown.parts) > 1 else ""),
            x.title,
            y.title,
            [label_text(x, value) for value in columns],
            [label_text(y, value) for value in rows],
            cells,
            Axis("", "", (scale.shown(shown.low), scale.shown(shown.high))),
        )
    )
