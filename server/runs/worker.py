"""What worker processes do besides computing outcomes: they keep the files of a run, or draw a figure."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from scenarios.campaign.campaign import Others
from scenarios.campaign.outcome import Outcome, outcome_of
from scenarios.campaign.signs import tell
from scenarios.campaign.single import counterparts, summary
from scenarios.run import DEFAULT_SAMPLES, Result, build, run, run_bytes
from scenarios.schema import Scenario

NICE = 10
STEM = "run"


class NotKept(Exception):
    """The files of a run could not be written; says why."""


@dataclass(frozen=True)
class Keep:
    """Keeps trace, report, drawing and script of a run.

    Parameters
    ----------
    folder : str
        Where the files go, each under a temporary name first.
    most_bytes : int
        Memory of the process; taps that would not fit are left out, then outputs that no figure is made of.
    """

    folder: str
    most_bytes: int

    def __call__(self, document: dict[str, Any], seed: int, others: Others) -> tuple[Outcome, dict[str, Any]]:
        """Run a scenario; return its outcome, and the summary of all its seeds, counterparts beside each expectation.

        Raises
        ------
        Cancelled
            When the work was called off.
        NotKept
            When the disk failed.
        """
        from scenarios.report.keeping import keep

        scenario = Scenario.load(document)
        board, samples = build(scenario), scenario.samples or DEFAULT_SAMPLES
        taps = run_bytes(board, samples, taps=True) <= self.most_bytes
        result = run(scenario, seed, taps=taps, figures_only=run_bytes(board, samples) > self.most_bytes, on_tick=tell)
        runs, told = _summary(result, others)
        try:
            keep(result, told, [one.seed for one in runs], Path(self.folder) / STEM)
        except OSError as error:
            raise NotKept(error.strerror or str(error)) from None
        return runs[0], told


def draw(document: dict[str, Any], seed: int, others: Others) -> tuple[Outcome, dict[str, Any]]:
    """Run a scenario; return its outcome, and its summary with its figure. Nothing else of it is kept."""
    from scenarios.report.figure import figure
    from scenarios.report.svg import CARD, paint

    result = run(Scenario.load(document), seed, on_tick=tell)
    runs, told = _summary(result, others)
    return runs[0], {"summary": told, "svg": paint(figure(result), CARD)}


def _summary(result: Result, others: Others) -> tuple[list[Outcome], dict[str, Any]]:
    """Return the outcomes of a run, seed by seed, and their summary."""
    rest, *beside = [[Outcome.model_validate_json(text) for text in texts] for texts in others]
    runs = [outcome_of(result), *rest]
    told = summary(result.scenario, runs, dict(zip(counterparts(result.scenario), beside, strict=True)))
    return runs, json.loads(json.dumps(told, default=str))
