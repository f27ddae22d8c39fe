"""What a worker process does: run a scenario for its seeds and write trace and summary."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from statistics import fmean, pstdev
from typing import Any

NICE = 10
LOOK_S = 0.1
SUMMARY, TRACE, PROGRESS, CANCEL = "summary.json", "trace.parquet", "progress", "cancel"


class Cancelled(Exception):
    """Somebody asked for the run to end."""


class Watch:
    """Writes how far a run is, and looks whether it is still wanted.

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
        """Return what to call after every chunk, when so many ticks were done by earlier seeds."""

        def look(tick: int) -> None:
            if time.monotonic() < self._due:
                return
            self._due = time.monotonic() + LOOK_S
            if (self._place / CANCEL).exists():
                raise Cancelled
            (self._place / PROGRESS).write_text(str((before + tick) / self._total))

        return look


def work(document: dict[str, Any], seeds: list[int], folder: str) -> dict[str, Any]:
    """Run a scenario once per seed; the trace of the first is kept.

    Parameters
    ----------
    document : dict
        The scenario.
    seeds : list of int
        At least one.
    folder : str
        Where the results go, each under a temporary name first.

    Returns
    -------
    dict
        The summary; with several seeds metrics are means and ``metrics_std`` is added.

    Raises
    ------
    Cancelled
        When a file ``cancel`` has appeared in the folder.
    """
    import numpy as np

    from scenarios.run import DEFAULT_SAMPLES, run
    from scenarios.schema import Scenario
    from scenarios.traces import write_json, write_parquet

    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    scenario = Scenario.load(document)
    summaries: list[dict[str, Any]] = []
    samples = scenario.samples or DEFAULT_SAMPLES
    watch = Watch(place, samples * len(seeds))
    for number, seed in enumerate(seeds):
        watch.at(number * samples)(0)
        result = run(scenario, seed, taps=number == 0, on_tick=watch.at(number * samples))
        summaries.append(result.summary())
        if number == 0:
            signals = {signal.name: result.signal(signal.name) for signal in result.board.signals}
            ticks = np.arange(result.board.tick)
            columns = {"tick": ticks, "time_ms": ticks * result.board.dt_ms, **signals}
            write_parquet(place / TRACE, columns, {"scenario": document, "seed": seed})
    summary = summaries[0] if len(summaries) == 1 else together(scenario, summaries)
    summary = json.loads(json.dumps(summary, default=str))
    write_json(place / SUMMARY, summary)
    return dict(summary)


def together(scenario: Any, summaries: list[dict[str, Any]]) -> dict[str, Any]:
    """Join the summaries of several seeds: means, standard deviations, expectations of the means."""
    from scenarios.run import judge

    names = summaries[0]["metrics"]
    values = {name: [one["metrics"][name] for one in summaries if name in one["metrics"]] for name in names}
    means = {name: fmean(found) for name, found in values.items()}
    expectations = judge(scenario, means)
    return {
        **summaries[0],
        "seeds": [one["seed"] for one in summaries],
        "elapsed_s": sum(one["elapsed_s"] for one in summaries),
        "digest": "",
        "digests": [one["digest"] for one in summaries],
        "metrics": means,
        "metrics_std": {name: pstdev(found) for name, found in values.items()},
        "expectations": expectations,
        "ok": all(entry["ok"] for entry in expectations),
    }
