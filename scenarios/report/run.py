"""The report of a run: one HTML file that needs nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from core.format import format_beside, format_count, format_figure, format_in, format_number, format_short, unit_text
from scenarios.measure.blocks import is_zero
from scenarios.metric_name import metric_scale, metric_text
from scenarios.narrator.words import diagnosis_words
from scenarios.report.axis import Axis
from scenarios.report.figure import TIME, figure, marks
from scenarios.report.html import as_toml, page
from scenarios.report.palette import LineStyle, hypothesis, signal
from scenarios.report.svg import Chart, Series, thin
from scenarios.run import RunResult

MOST_EVENTS = 300
CLOSE_UP = 300
"""Number of ticks at the end that are drawn one by one."""
OTHERS = ("open_loop", "pid")
"""Controllers in place of the controllers of the scenario, whose figures are printed next to its own."""
CHARTS = (
    ("Displacement", ("model.displacement", "plant.displacement", "sensor.displacement")),
    ("Voltage", ("reference.voltage", "drive.voltage")),
    ("Lateral motion", ("plant.shift", "plant.rotation")),
)


def run_report(result: RunResult, summary: dict[str, Any]) -> str:
    """Return the report of a run.

    Parameters
    ----------
    result : Result
        The run; with several seeds the first.
    summary : dict
        Its summary, with means over the seeds if there are several.
    """
    head = result.scenario.head
    seeds, spread, trip = summary.get("seeds"), summary.get("metrics_std", {}), summary["trip"]
    ticks = f"{format_count(summary['ticks'], 'tick')} of {format_short(summary['dt_s'], 's')}"
    entries = [entry for entry in result.board.log if entry.kind != "scheduled"]
    return page(
        "run.html",
        head.title or result.scenario.id,
        head=head,
        verdict=summary["verdict"] or "none",
        seeds=f"seeds {seeds[0]} to {seeds[-1]}, charts of the first" if seeds else f"seed {summary['seed']}",
        ticks=ticks if summary["ticks"] else "",
        digest=summary["digest"],
        trip=f"{format_in(trip['time_ms'], 'ms', 3)}: {trip['reason']}" if trip else "",
        warnings=summary["warnings"],
        expectations=[_expectation(entry) for entry in summary["expectations"]],
        charts=_charts(result),
        verdicts=_verdicts(result),
        narration=[said.text for said in result.narration[:MOST_EVENTS]],
        told=len(result.narration),
        figures=[_figure(name, value, spread) for name, value in summary["metrics"].items()],
        has_spread=bool(spread),
        events=[
            [format_number(entry.tick * result.board.dt_ms, 3), entry.tick, entry.actor, entry.text]
            for entry in entries[:MOST_EVENTS]
        ],
        count=len(entries),
        document=as_toml(result.scenario.document),
    )


def _figure(metric: str, value: float, spread: dict[str, float]) -> list[str]:
    """Return a row of the figures: title, value, and with several seeds the deviation."""
    scale = metric_scale(metric, [value])
    row = [scale.title, format_figure(metric, scale.shown(value), 6)]
    if spread:
        row.append(format_beside(scale.shown(spread.get(metric, 0.0)), scale.shown(value), 6))
    return row


def _expectation(entry: dict[str, Any]) -> list[str]:
    """Return a row of the expectations."""
    metric = entry["metric"]
    return [
        metric_scale(metric).name,
        entry["published"],
        entry.get("expected_words", entry["expected"]),
        metric_text(metric, entry["measured"], 6),
        "holds" if entry["ok"] else "does not hold",
        *(metric_text(metric, entry.get(name), 6) for name in OTHERS),
        entry["verdict"] or "",
        "; ".join(filter(None, (entry["note"], _comparator(entry)))),
    ]


def _comparator(entry: dict[str, Any]) -> str:
    """Name the PID of a row, and whether it meets the claim."""
    name: str = entry.get("comparator", "")
    return f"{name} meets the claim too" if entry.get("pid_too") else name


def _charts(result: RunResult) -> list[Chart]:
    """Return the figure of the run, and its traces, each column of pixels with its smallest and largest value."""
    if result.samples < 2:
        return [figure(result)]
    dt_ms = result.board.dt_ms
    time = Axis(TIME, "ms", (0.0, (result.samples - 1) * dt_ms))
    signals = {signal.name: signal for signal in result.kept}
    done = marks(result)
    charts = [figure(result)]
    for title, names in _groups(result):
        chosen = [name for name in names if name in signals and not is_zero(result.signal(name))]
        looks = [signal(name, number) for number, name in enumerate(chosen)]
        lines = [_series(name, result, name, look) for name, look in zip(chosen, looks, strict=True)]
        if lines:
            units = list(dict.fromkeys(signals[name].unit for name in chosen))
            y = Axis("", units[0]) if len(units) == 1 else Axis(", ".join(map(unit_text, units)))
            charts.append(Chart(title, time, y, lines, done))
            if result.samples > 4 * CLOSE_UP:  # too many periods for one picture
                end = (np.arange(result.samples - CLOSE_UP, result.samples) * dt_ms).tolist()
                lines = [
                    Series(name, end, result.signal(name)[-CLOSE_UP:].tolist(), look=look)
                    for name, look in zip(chosen, looks, strict=True)
                ]
                charts.append(Chart(f"{title}, the last {CLOSE_UP} ticks", Axis(TIME, "ms"), y, lines))
    for name in result.board.spec.identifiers:
        if f"{name}.error_pct" in signals:
            line = _series(name, result, f"{name}.error_pct")
            charts.append(Chart(f"Identifier {name}", time, Axis("error", "%"), [line], done))
    for name, scores in result.board.scores().items():
        chosen = [f"{name}.probability.{label}" for label in scores.names]
        if all(column in signals for column in chosen):
            lines = [
                _series(label, result, column, hypothesis(number))
                for number, (label, column) in enumerate(zip(scores.names, chosen, strict=True))
            ]
            charts.append(Chart(f"Diagnoser {name}", time, Axis("probability", "", (0.0, 1.0)), lines, done))
    return charts


def _series(said: str, result: RunResult, name: str, look: LineStyle | None = None) -> Series:
    """Return a signal as a line."""
    samples, values = thin(np.asarray, result.signal(name))
    return Series(said, (samples * result.board.dt_ms).tolist(), values, look=look)


def _groups(result: RunResult) -> Sequence[tuple[str, tuple[str, ...]]]:
    """Return title and signals of every chart of traces; a plant with axes has one for each of them, and the rate."""
    spec = result.board.spec
    if not spec.axes:
        return CHARTS
    along = [(f"Displacement {axis}", (f"plant.{axis}",)) for axis in spec.axes]
    forces = tuple(f"drive.{axis}.force" for axis in spec.axes)
    return [("Angular rate", (f"{spec.active}.rate", "rate.rate")), *along, ("Force", forces)]


def _verdicts(result: RunResult) -> list[dict[str, Any]]:
    """Return the verdicts of each diagnoser against the truth."""
    words = diagnosis_words(result.board.spec.diagnosers)
    said = {name: [words.get(one, one) for one in scores.names] for name, scores in result.board.scores().items()}
    return [
        {
            "name": words[name],
            "names": said[name],
            "rows": [[truth, *row] for truth, row in zip(said[name], scores.confusion, strict=True)],
            "delays": ", ".join("not found" if delay is None else format_number(delay, 0) for delay in scores.delays),
        }
        for name, scores in result.board.scores().items()
    ]
