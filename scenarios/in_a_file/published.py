"""The published run of a scenario: its claim, its figures and its digest, with which a reader's run is compared."""

from __future__ import annotations

from typing import Any

from core.format import format_short
from scenarios.campaign.single import beside
from scenarios.claims import marks
from scenarios.metric_name import metric_unit
from scenarios.run import run
from scenarios.schema import Scenario


def published(scenario: Scenario) -> dict[str, Any]:
    """Run a scenario to its end, and return the part of its summary that a file shows."""
    result = run(scenario, figures_only=True)
    summary = beside(result)
    return {
        "source": summary["source"],
        "claim": summary["claim"],
        "verdict": summary["verdict"] or "",
        "ticks": summary["ticks"],
        "digest": summary["digest"],
        "expectations": [
            {
                "metric": entry["metric"],
                "published": entry["published"],
                "expected": entry["expected_words"],
                "measured": _words(entry["measured"], entry["metric"]),
                "ok": entry["ok"],
            }
            for entry in summary["expectations"]
        ],
        "marks": [mark.model_dump() for mark in marks(scenario, list(result.board.signals)) if not mark.problem],
    }


def _words(value: float | None, metric: str) -> str:
    return "" if value is None else format_short(value, metric_unit(metric))
