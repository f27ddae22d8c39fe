"""A run in words and numbers, for the command line."""

from __future__ import annotations

import textwrap
from typing import Any

from core.format import format_in, format_short, format_si, format_spread
from scenarios.metric_name import metric_text, metric_unit

BESIDE = ("measured", "open_loop", "pid")
"""Figures of one expectation: its own, and the figures of other controllers in the same scenario."""
WIDTH = 100
"""Columns of the gallery."""


def run_text(summary: dict[str, Any]) -> str:
    """Return all of a run: its claim, its figures, and its expectations."""
    lines = [f"{summary['scenario']}: {summary['title']}"]
    if summary["claim"]:
        lines.append(f"  claim    {summary['claim']} ({summary['verdict']})")
    took = format_si(summary["elapsed_s"], "s", 3)
    lines.append(f"  ticks    {summary['ticks']} of {format_short(summary['dt_s'], 's')} in {took}")
    lines.append(f"  digest   {summary['digest']}")
    if trip := summary["trip"]:
        lines.append(f"  tripped  at {format_in(trip['time_ms'], 'ms', 3)}: {trip['reason']}")
    lines += [f"  warning  {text}" for text in summary["warnings"]]
    lines += [line for said in summary.get("narration", ()) for line in _wrapped(said["text"], 2)]
    for name, value in summary["metrics"].items():
        spread = summary.get("metrics_std", {}).get(name)
        text = format_spread(name, value, spread, metric_unit(name)) if spread else metric_text(name, value, 6)
        lines.append(f"  {name:<44} {text}")
    lines += [f"  {'ok  ' if entry['ok'] else 'MISS'} {_row(entry)}" for entry in summary["expectations"]]
    return "\n".join(lines)


def gallery_text(summary: dict[str, Any]) -> str:
    """Return the claim of a scenario, its verdict, its warnings and its expectations, at most `WIDTH` wide."""
    mark = "ok  " if summary["ok"] else "MISS"
    lines = [_ended(f"{mark} {summary['scenario']}", summary["verdict"]), *_wrapped(summary["claim"], 5)]
    lines += [line for text in summary["warnings"] for line in _wrapped(f"warning: {text}", 5)]
    for entry in summary["expectations"]:
        lines += [_ended(f"       {entry['metric']}", entry["verdict"]), *_wrapped(_figures(entry), 9)]
    return "\n".join(lines)


def _ended(text: str, word: str | None) -> str:
    """Return a line with a word at its right end."""
    return f"{text} {word or '':>{WIDTH - len(text) - 1}}".rstrip()


def _wrapped(text: str, indent: int) -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=" " * indent, subsequent_indent=" " * indent)


def _row(entry: dict[str, Any]) -> str:
    """Return an expectation in one line."""
    return f"{entry['metric']} {_figures(entry)}" + (f", {entry['verdict']}" if entry["verdict"] else "")


def _figures(entry: dict[str, Any]) -> str:
    """Return the expected figure, the measured figure, the figures of other controllers, and the published figure."""
    figures = {name: entry[name] for name in BESIDE if entry.get(name) is not None}
    names = {"measured": "measured", "open_loop": "open loop", "pid": f"{entry.get('comparator')} gives"}
    said = [f"{names[name]} {metric_text(entry['metric'], value, 6)}" for name, value in figures.items()]
    said += [] if "measured" in figures else ["not measured"]
    said += ["which meets the claim too"] if entry.get("pid_too") else []
    said += [f"published: {entry['published']}"] if entry["published"] else []
    return f"{entry['expected_words']}: {', '.join(said)}"
