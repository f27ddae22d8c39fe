"""Summary of a run, as ``run --json`` prints it: the expected and the measured figures."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from core.board.commands import Trip
from core.format import micro
from scenarios.expectation import overall
from scenarios.schema import Scenario

NOTHING: Mapping[str, float] = MappingProxyType({})


def judge(scenario: Scenario, metrics: dict[str, float], pid: Mapping[str, float] = NOTHING) -> list[dict[str, Any]]:
    """Return each expectation of a scenario with the measured figure; ``pid`` has the figures of its comparator."""
    return [
        {
            "metric": entry.metric,
            "published": entry.published,
            "expected": entry.text(),
            "expected_words": entry.words(),
            "measured": metrics.get(entry.metric),
            "ok": entry.holds(metrics.get(entry.metric)),
            "published_value": entry.published_value,
            "verdict": entry.word(metrics.get(entry.metric), pid.get(entry.metric)),
            "note": entry.note if entry.metric in metrics else "no such metric in this run",
        }
        for entry in scenario.head.expect
    ]


def summarise(
    scenario: Scenario,
    seed: int,
    ticks: int,
    elapsed_s: float,
    metrics: dict[str, float],
    digest: str,
    trip: Trip | None,
    warnings: list[str],
    pid: Mapping[str, float] = NOTHING,
) -> dict[str, Any]:
    """Return the summary of a run, JSON-ready; ``pid`` has the figures of its comparator."""
    expectations = judge(scenario, metrics, pid)
    return {
        "scenario": scenario.id,
        "title": scenario.head.title,
        "source": scenario.head.source,
        "claim": scenario.head.claim,
        "verdict": overall(entry["verdict"] for entry in expectations),
        "seed": seed,
        "ticks": ticks,
        "dt_s": scenario.spec.dt_ms / 1e3,
        "elapsed_s": elapsed_s,
        "digest": digest,
        "trip": trip.model_dump() if trip is not None else None,
        "warnings": [micro(text) for text in warnings],
        "metrics": metrics,
        "expectations": expectations,
        "ok": all(entry["ok"] for entry in expectations),
    }
