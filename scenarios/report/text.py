"""A run in words and numbers, for the command line."""

from __future__ import annotations

from typing import Any

from core.format import format_figure, format_in, format_short, format_si

BESIDE = ("measured", "open_loop", "pid")
"""Figures of one expectation: its own, and those of other controllers in the same scenario."""


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
    for name, value in summary["metrics"].items():
        spread = summary.get("metrics_std", {}).get(name)
        after = f" ± {format_short(spread, '', 2)}" if spread else ""
        lines.append(f"  {name:<44} {format_figure(name, value, 6)}{after}")
    lines += [f"  {'ok  ' if entry['ok'] else 'MISS'} {_row(entry)}" for entry in summary["expectations"]]
    return "\n".join(lines)


def gallery_text(summary: dict[str, Any]) -> str:
    """Return what a scenario claims, its verdict, its warnings and its expectations."""
    mark, word = "ok  " if summary["ok"] else "MISS", summary["verdict"] or ""
    lines = [f"{mark} {summary['scenario']:<28} {word:<22} {summary['claim']}"]
    lines += [f"       warning: {text}" for text in summary["warnings"]]
    lines += [f"       {_row(entry)}" for entry in summary["expectations"]]
    return "\n".join(lines)


def _row(entry: dict[str, Any]) -> str:
    """Return an expectation: what was measured, what other controllers give, what was published, and the word."""
    figures = {name: entry[name] for name in BESIDE if entry.get(name) is not None}
    said = [f"{name.replace('_', ' ')} {format_figure(entry['metric'], value, 6)}" for name, value in figures.items()]
    said += [f"published: {entry['published']}"] if entry["published"] else []
    said += [entry["verdict"]] if entry["verdict"] else []
    return f"{entry['metric']} {entry['expected']}: {', '.join(said) or 'not measured'}"
