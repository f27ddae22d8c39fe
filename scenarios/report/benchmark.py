"""Results of the benchmark as a table of text, for the command line and for documents."""

from __future__ import annotations

from core.format import format_number, format_share, format_si
from scenarios.benchmark.figures import WIDE, Estimate
from scenarios.benchmark.results import BenchmarkResults, Row
from scenarios.benchmark.track import BenchmarkTrack

HEAD = (
    "log score",
    "Brier",
    "delay",
    "missed",
    "detection",
    "false alarm",
    "isolation",
    "given to truth",
    "false switches",
)
NONE = "-"


def benchmark_text(results: BenchmarkResults, tracks: dict[str, BenchmarkTrack]) -> str:
    """Return all measured tracks, the data to recompute them, and the diagnosers that are left out."""
    lines = []
    for name, track in tracks.items():
        rows = results.ranked(name)
        if rows:
            lines += [f"{name}: {track.question}", *track_table(results, name)]
            lines += [f"  digest of {row.unit}: {row.digest}" for row in rows]
            lines += [f"  scenarios: {rows[0].scenario}", ""]
    lines += [f"{one.unit} is not scored in {one.track}: it {one.reason}" for one in results.left_out]
    for unit, cost in results.costs.items():
        beside = f"{format_number(cost.over_mmae, 2)} of the Kalman bank"
        lines.append(f"{unit}: {format_si(cost.ns_per_sample, 'ns', 3)} per sample, {beside}")
    lines.append(f"seeds {results.seeds}, one false alarm in {results.false_alarm_samples} samples, {results.version}")
    return "\n".join(lines)


def track_table(results: BenchmarkResults, track: str) -> list[str]:
    """Return the lines of a track, best diagnoser first, with half the width of the 95 % intervals."""
    return _aligned([("", *HEAD), *(_cells(row) for row in results.ranked(track))])


def _cells(row: Row) -> tuple[str, ...]:
    """Return the figures of a row as texts."""
    shares = (row.missed, row.detection, row.false_alarm, row.isolation, row.truth_probability)
    return (
        row.unit,
        _number(row.log_score, 3),
        _number(row.brier, 3),
        _number(row.delay_samples, 0),
        *(NONE if one is None else format_share(one.mean, 3) for one in shares),
        _number(row.false_switches, 1),
    )


def _number(figure: Estimate | None, decimals: int) -> str:
    if figure is None:
        return NONE
    return f"{format_number(figure.mean, decimals)} ±{format_number(WIDE * figure.error, decimals)}"


def _aligned(rows: list[tuple[str, ...]]) -> list[str]:
    """Return rows with their columns aligned to the right, names to the left."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return [
        f"  {row[0]:<{widths[0]}}" + "".join(f"  {cell:>{w}}" for cell, w in zip(row[1:], widths[1:], strict=True))
        for row in rows
    ]
