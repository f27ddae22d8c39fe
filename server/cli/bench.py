"""The command for speed: measures, prints the table against C and the figures against peers."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from core.format import format_si, unit_text
from server.cli.terminal import JsonOption, plainly, say, say_json


@plainly
def bench(
    quick: Annotated[bool, typer.Option("--quick", help="Only the ratios to C and the watchers, in a minute.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Measure speed, each figure as a ratio to a peer in the same run; exit code 1: the C gives other bits."""
    from scenarios.speed.ratios import speed
    from server.cli.watchers import watchers

    report = speed(quick)
    report["figures"] += watchers()
    report["ok"] = all(row["ok"] for row in (*report["anchor"], *report["figures"]))
    if as_json:
        say_json(report)
    else:
        _show(report)
    raise typer.Exit(1 if any(row.get("differences") for row in report["anchor"]) else 0)


def _show(report: dict[str, Any]) -> None:
    """Print the report for people."""
    for line in _machine(report["machine"]):
        say(line)
    say(f"{'':4} {'per tick, or run: median (lower quartile)':<42} {'ours':>18} {'C':>18} {'ours / C':>13}  goal")
    for row in report["anchor"]:
        say(_against_c(row))
    for row in report["figures"]:
        mark = "info" if row["target"] == "information" else "ok  " if row["ok"] else "MISS"
        value, low, high = (format_si(row[name], "") for name in ("value", "low", "high"))
        say(f"{mark} {value:>7} {unit_text(row['unit']):<3} [{low} to {high}]  {row['target']:<24} {row['name']}")
    if report["blocks_ns"]:
        say("cost of each block, ns per tick:")
        say("  " + "  ".join(f"{name} {format_si(value, '')}" for name, value in report["blocks_ns"].items()))
    for text in report["missing"]:
        say(text)


def _machine(machine: dict[str, Any]) -> list[str]:
    vectors = " and ".join(machine["vectors"]) or "no wide vectors"
    lines = [
        ", ".join(
            filter(None, [machine["processor"], f"{machine['processors']} processors", vectors, machine["compiler"]])
        )
    ]
    if machine["busy"]:
        lines.append(f"the machine is busy (load {machine['load']:.1f}): trust only ratios, and these roughly")
    return lines


def _against_c(row: dict[str, Any]) -> str:
    ours = _cost(row, "ours")
    name = f"{row['bench']}, {row['part']}"
    if "ratio" not in row:
        return f"info {name:<42} {ours:>18}"
    ratio = f"{row['ratio']:.2f} ({row['ratio_of_lower_quartiles']:.2f})"
    mark = "ERR " if row["differences"] else "ok  " if row["ok"] else "MISS"
    line = f"{mark} {name:<42} {ours:>18} {_cost(row, 'c'):>18} {ratio:>13}  <= {row['goal']:.2f}"
    return f"{line}  the C differs: {', '.join(row['differences'])}" if row["differences"] else line


def _cost(row: dict[str, Any], name: str) -> str:
    middle, lower = row[f"{name}_ns"], row[f"{name}_lower_quartile_ns"]
    unit, scale = ("ms", 1e-6) if middle >= 1e6 else ("us", 1e-3)
    return f"{middle * scale:.2f} ({lower * scale:.2f}) {unit}"
