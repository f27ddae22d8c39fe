"""The report of a run: one HTML file that needs nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np

from core.format import format_count, format_figure, format_in, format_number, format_short
from scenarios.report.html import as_toml, page, table
from scenarios.report.palette import hypothesis, signal
from scenarios.report.svg import Mark, Series, chart, thin
from scenarios.run import Result

MOST_EVENTS = 300
CLOSE_UP = 300
"""Number of ticks at the end that are drawn one by one."""
DONE = ("inject", "heal", "set", "switch", "reset_trip", "tripped")
"""Kinds of log entries that are marked on the charts."""
CHARTS = (
    ("Displacement", ("model.displacement", "plant.displacement", "sensor.displacement")),
    ("Voltage", ("reference.voltage", "drive.voltage")),
    ("Lateral motion", ("plant.shift", "plant.rotation")),
)


def run_report(result: Result, summary: dict[str, Any]) -> str:
    """Return the report of a run.

    Parameters
    ----------
    result : Result
        The run; with several seeds the first.
    summary : dict
        Its summary, with means over the seeds if there are several.
    """
    head = result.scenario.head
    seeds = summary.get("seeds")
    who = f"seeds {seeds[0]} to {seeds[-1]}, charts of the first" if seeds else f"seed {summary['seed']}"
    body = [f"<p>{escape(head.summary)}</p>" if head.summary else ""]
    if head.claim:
        body.append(f"<p><b>Claim:</b> {escape(head.claim)}. <b>Verdict:</b> {escape(head.verdict or 'none')}.</p>")
    body.append(f"<p>{escape(head.source)}</p>" if head.source else "")
    body.append(f"<p>{who}; {format_count(summary['ticks'], 'tick')} of {format_short(summary['dt_s'], 's')}; digest ")
    body.append(f"<code>{summary['digest']}</code></p>")
    if summary["trip"]:
        trip = summary["trip"]
        body.append(f'<p class="miss">Tripped at {format_in(trip["time_ms"], "ms", 3)}: {escape(trip["reason"])}</p>')
    body += [f'<p class="miss">Warning: {escape(text)}</p>' for text in summary["warnings"]]
    body.append(_expectations(summary["expectations"]))
    body.append(f'<div class="side">{"".join(f"<div>{drawing}</div>" for drawing in _charts(result))}</div>')
    body += _verdicts(result)
    spread = summary.get("metrics_std", {})
    figures = [
        [name, format_figure(name, value, 6), *([spread.get(name, 0.0)] if spread else [])]
        for name, value in summary["metrics"].items()
    ]
    body.append(
        "<h2>Figures</h2>" + table(["figure", "mean" if spread else "value", *(["std"] if spread else [])], figures)
    )
    body.append(_events(result))
    body.append(f"<h2>Scenario</h2><pre>{escape(as_toml(result.scenario.document))}</pre>")
    return page(head.title or result.scenario.id, "".join(body))


def _expectations(entries: Sequence[dict[str, Any]]) -> str:
    if not entries:
        return ""
    rows = [
        [
            entry["metric"],
            entry["published"],
            entry["expected"],
            "-" if entry["measured"] is None else format_figure(entry["metric"], entry["measured"], 6),
            "holds" if entry["ok"] else "does not hold",
            entry["verdict"] or "",
            entry["note"],
        ]
        for entry in entries
    ]
    return "<h2>Expectations</h2>" + table(["figure", "published", "expected", "measured", "", "verdict", "note"], rows)


def _charts(result: Result) -> list[str]:
    """Draw the traces, each column of pixels with its smallest and largest value."""
    if len(result.outputs) < 2:
        return []
    time_ms = np.arange(float(len(result.outputs))) * result.board.dt_ms
    span = (0.0, float(time_ms[-1]))
    signals = {signal.name: signal for signal in result.kept}
    marks = [
        Mark(entry.tick * result.board.dt_ms, entry.text)
        for entry in result.board.log
        if entry.kind in DONE and entry.tick
    ]
    charts = []
    for title, names in _groups(result):
        chosen = [name for name in names if name in signals and np.any(result.signal(name))]
        looks = [signal(name, number) for number, name in enumerate(chosen)]
        lines = [
            Series(name, *thin(time_ms, result.signal(name)), look=look)
            for name, look in zip(chosen, looks, strict=True)
        ]
        if lines:
            label = ", ".join(dict.fromkeys(signals[name].unit for name in chosen))
            charts.append(chart(title, "time, ms", label, lines, span, marks=marks))
            if len(time_ms) > 4 * CLOSE_UP:  # too many periods for one picture
                end = slice(-CLOSE_UP, None)
                lines = [
                    Series(name, time_ms[end].tolist(), result.signal(name)[end].tolist(), look=look)
                    for name, look in zip(chosen, looks, strict=True)
                ]
                charts.append(chart(f"{title}, the last {CLOSE_UP} ticks", "time, ms", label, lines))
    for name in result.board.spec.identifiers:
        if f"{name}.error_pct" in signals:
            line = Series(name, *thin(time_ms, result.signal(f"{name}.error_pct")))
            charts.append(chart(f"Identifier {name}", "time, ms", "error, %", [line], span, marks=marks))
    for name, scores in result.board.scores().items():
        chosen = [f"{name}.probability.{label}" for label in scores.names]
        if all(column in signals for column in chosen):
            lines = [
                Series(label, *thin(time_ms, result.signal(column)), look=hypothesis(number))
                for number, (label, column) in enumerate(zip(scores.names, chosen, strict=True))
            ]
            charts.append(chart(f"Diagnoser {name}", "time, ms", "probability", lines, span, (0.0, 1.0), marks))
    return charts


def _groups(result: Result) -> Sequence[tuple[str, tuple[str, ...]]]:
    """Return title and signals of every chart of traces; a plant with axes has one for each of them, and the rate."""
    spec = result.board.spec
    if not spec.axes:
        return CHARTS
    along = [(f"Displacement {axis}", (f"plant.{axis}",)) for axis in spec.axes]
    forces = tuple(f"drive.{axis}.force" for axis in spec.axes)
    return [("Angular rate", (f"{spec.active}.rate", "rate.rate")), *along, ("Force", forces)]


def _verdicts(result: Result) -> list[str]:
    """Show the verdicts of each diagnoser against the truth."""
    parts = []
    for name, scores in result.board.scores().items():
        delays = ", ".join("not found" if delay is None else f"{delay}" for delay in scores.delays)
        parts.append(f"<h2>Diagnoser {escape(name)}: truth (rows) and verdict (columns), samples</h2>")
        rows = [[truth, *row] for truth, row in zip(scores.names, scores.confusion, strict=True)]
        parts.append(table(["truth", *scores.names], rows))
        parts.append(f"<p>Samples to find each truth: {delays or 'none'}.</p>")
    return parts


def _events(result: Result) -> str:
    """List the events of the run."""
    entries = [entry for entry in result.board.log if entry.kind != "scheduled"]
    dt_ms = result.board.dt_ms
    rows = [[format_number(e.tick * dt_ms, 3), e.tick, e.actor, e.text] for e in entries[:MOST_EVENTS]]
    cut_off = f"<p>The first {MOST_EVENTS} of {len(entries)}.</p>" if len(entries) > MOST_EVENTS else ""
    return f"<h2>Events</h2>{cut_off}{table(['time, ms', 'tick', 'who', 'what'], rows)}" if rows else ""
