"""The work of a worker process: it runs a scenario for its seeds and keeps the results."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

NICE = 10
REPORT_S = 0.1
STEM, PROGRESS, CANCEL = "run", "progress", "cancel"


class Cancelled(Exception):
    """The run was cancelled."""


class Watch:
    """Writes the progress of a run, and checks whether it was cancelled.

    Parameters
    ----------
    place : Path
        Folder of the run.
    total : int
        Ticks of all its seeds.
    """

    def __init__(self, place: Path, total: int) -> None:
        self._place, self._total, self._due = place, total, 0.0

    def at(self, before: int) -> Callable[[int], None]:
        """Return the function to call after every chunk, when earlier seeds took so many ticks."""

        def report(tick: int) -> None:
            if time.monotonic() < self._due:
                return
            self._due = time.monotonic() + REPORT_S
            if (self._place / CANCEL).exists():
                raise Cancelled
            (self._place / PROGRESS).write_text(str((before + tick) / self._total))

        return report


def work(document: dict[str, Any], seeds: list[int], folder: str, most_bytes: int) -> dict[str, Any]:
    """Run a scenario once per seed; trace, report and drawing are of the first.

    Parameters
    ----------
    document : dict
        The scenario.
    seeds : list of int
        At least one.
    folder : str
        Where the results go, each under a temporary name first.
    most_bytes : int
        Memory of the process; taps that would not fit are left out, then outputs that no figure is made of.

    Returns
    -------
    dict
        The summary, with the open loop beside each expectation; with several seeds metrics are means and
        ``metrics_std`` is added.

    Raises
    ------
    Cancelled
        When a file ``cancel`` has appeared in the folder.
    """
    from scenarios.counterpart import beside
    from scenarios.report.keeping import keep
    from scenarios.run import DEFAULT_SAMPLES, Result, build, run, run_bytes
    from scenarios.schema import Scenario
    from scenarios.seeds import together

    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    scenario = Scenario.load(document)
    summaries: list[dict[str, Any]] = []
    samples = scenario.samples or DEFAULT_SAMPLES
    watch = Watch(place, samples * len(seeds))
    board = build(scenario)
    has_room = run_bytes(board, samples, taps=True) <= most_bytes
    figures_only = run_bytes(board, samples) > most_bytes
    kept: Result | None = None
    for number, seed in enumerate(seeds):
        told = watch.at(number * samples)
        told(0)
        taps = has_room and number == 0
        result = run(scenario, seed, taps=taps, figures_only=figures_only or number > 0, on_tick=told)
        summaries.append(result.summary())
        kept = kept or result
    assert kept is not None
    summary = summaries[0] if len(summaries) == 1 else together(scenario, summaries)
    summary = dict(json.loads(json.dumps(beside(summary, scenario), default=str)))
    keep(kept, summary, seeds, place / STEM)
    return summary


def draw(document: dict[str, Any]) -> dict[str, Any]:
    """Run a scenario with its own seed, and return its summary and its figure; nothing else of it is kept."""
    from scenarios.counterpart import beside
    from scenarios.report.figure import figure
    from scenarios.report.svg import CARD, paint
    from scenarios.run import run
    from scenarios.schema import Scenario

    result = run(Scenario.load(document))
    summary = dict(json.loads(json.dumps(beside(result.summary(), result.scenario), default=str)))
    return {"summary": summary, "svg": paint(figure(result), CARD)}
