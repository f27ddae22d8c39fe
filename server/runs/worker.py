"""What a worker process does: run a scenario for its seeds and write trace and summary."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path
from statistics import fmean, pstdev
from typing import Any

NICE = 10
SUMMARY, TRACE, PROGRESS = "summary.json", "trace.parquet", "progress"


def prepare() -> None:
    """Give way to the live benches; leave Ctrl-C to the server."""
    os.nice(NICE)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    import scenarios.run  # noqa: F401  (load the kernels before the first run)


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
    """
    import numpy as np

    from scenarios.run import run
    from scenarios.schema import Scenario
    from scenarios.traces import write_json, write_parquet

    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    scenario = Scenario.load(document)
    summaries: list[dict[str, Any]] = []
    for number, seed in enumerate(seeds):
        result = run(scenario, seed, taps=number == 0)
        summaries.append(result.summary())
        if number == 0:
            signals = {signal.name: result.signal(signal.name) for signal in result.board.signals}
            ticks = np.arange(result.board.tick)
            columns = {"tick": ticks, "time_ms": ticks * result.board.dt_ms, **signals}
            write_parquet(place / TRACE, columns, {"scenario": document, "seed": seed})
        (place / PROGRESS).write_text(str((number + 1) / len(seeds)))
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
