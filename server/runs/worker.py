"""Work of worker processes besides outcomes: they keep the files of a run, or draw a figure."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from scenarios.campaign.campaign import Others
from scenarios.campaign.outcome import RunOutcome, outcome_of
from scenarios.campaign.progress import tell
from scenarios.campaign.single import counterparts, summary
from scenarios.run import DEFAULT_SAMPLES, RunResult, build, run
from scenarios.schema import Scenario
from scenarios.signals import traced

NICE = 10
STEM = "run"


class NotKept(Exception):
    """The files of a run could not be written; with the reason."""


@dataclass(frozen=True)
class Keep:
    """Keeps trace, report, drawing and script of a run.

    Parameters
    ----------
    folder : str
        Where the files go, each under a temporary name first.
    most_bytes : int
        Limit of the numbers of a trace; taps without room are left out, then outputs that no figure needs.
    everything : bool
        Keep the signals of blocks in shadow as well.
    """

    folder: str
    most_bytes: int
    everything: bool = False

    def __call__(self, document: dict[str, Any], seed: int, others: Others) -> tuple[RunOutcome, dict[str, Any]]:
        """Run a scenario; return its outcome, and the summary of all its seeds, with counterparts.

        Raises
        ------
        Cancelled
            When the work was called off.
        NotKept
            When the disk failed.
        """
        from scenarios.report.keeping import keep
        from scenarios.report.traces import TraceFile

        scenario = Scenario.load(document)
        room = self.most_bytes // (8 * (scenario.samples or DEFAULT_SAMPLES))
        board, everything, stem = build(scenario), self.everything, Path(self.folder) / STEM
        taps = len(traced(board, everything=everything)) <= room
        few = len(traced(board, taps=False, everything=everything)) > room
        try:
            with TraceFile(stem.with_suffix(".parquet"), scenario.document) as trace:
                result = run(
                    scenario,
                    seed,
                    taps=taps,
                    figures_only=few,
                    everything=everything,
                    trace=trace,
                    on_tick=tell,
                    narrate=True,
                )
                runs, told = _summary(result, others)
                keep(result, told, [one.seed for one in runs], stem)
        except OSError as error:
            raise NotKept(error.strerror or str(error)) from None
        return runs[0], told


def draw(document: dict[str, Any], seed: int, others: Others) -> tuple[RunOutcome, dict[str, Any]]:
    """Run a scenario; return its outcome, and its summary with its figure. Nothing else of it is kept."""
    from scenarios.report.figure import figure
    from scenarios.report.svg import CARD, paint

    result = run(Scenario.load(document), seed, on_tick=tell)
    runs, told = _summary(result, others)
    return runs[0], {"summary": told, "svg": paint(figure(result), CARD)}


def _summary(result: RunResult, others: Others) -> tuple[list[RunOutcome], dict[str, Any]]:
    """Return the outcomes of a run, seed by seed, and their summary."""
    rest, *beside = [[RunOutcome.model_validate_json(text) for text in texts] for texts in others]
    runs = [outcome_of(result), *rest]
    told = summary(result.scenario, runs, dict(zip(counterparts(result.scenario), beside, strict=True)))
    return runs, json.loads(json.dumps(told, default=str))
