"""A run with its seeds: a campaign of one point, and the same run with other controllers for comparison; its summary.

Whoever carries the runs out (command line, server, a point of a campaign), the summary is made here, from outcomes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from core.errors import InputError
from scenarios.campaign.batch import outcomes
from scenarios.campaign.moments import Moments
from scenarios.campaign.outcome import RunOutcome, outcome_of
from scenarios.campaign.sweep import Sweep
from scenarios.counterpart import counterpart, replaced
from scenarios.run import RunResult
from scenarios.schema import Scenario
from scenarios.summary import summarise

OWN = "own"
"""Name of the scenario among its counterparts."""


def single(scenario: Scenario, seeds: Sequence[int]) -> Sweep:
    """Return a run with its seeds as a campaign: its own point first, then a point for each counterpart."""
    others = [{"name": kind, "set": replaced(scenario, kind)} for kind in counterparts(scenario)]
    document = {"scenario": scenario.document, "seeds": f"{seeds[0]}:{seeds[-1]}"}
    return Sweep({**document, "variants": [{"name": OWN, "set": {}}, *others]} if others else document)


def counterparts(scenario: Scenario) -> dict[str, Scenario]:
    """Return the counterparts that the expectations of a scenario are compared with, by the controller in use."""
    kinds = ["open_loop"] if scenario.head.expect else []
    kinds += ["pid"] if any(entry.compare == "pid" for entry in scenario.head.expect) else []
    found = {}
    for kind in kinds:
        try:
            other = counterpart(scenario, kind)
        except InputError:  # the plant has none
            continue
        if other is not None:
            found[kind] = other
    return found


def compared(scenario: Scenario, seeds: Sequence[int]) -> dict[str, list[RunOutcome]]:
    """Carry out the counterparts of a scenario."""
    others = counterparts(scenario)
    return {kind: outcomes([(other, seed) for seed in seeds]) for kind, other in others.items()}


def beside(result: RunResult) -> dict[str, Any]:
    """Return the summary of a result for its use as a counterpart."""
    return summary(result.scenario, [outcome_of(result)], compared(result.scenario, [result.seed]))


def run_seeds(scenario: Scenario, seeds: Sequence[int]) -> dict[str, Any]:
    """Run a scenario once for each seed and return the summary."""
    return summary(scenario, outcomes([(scenario, seed) for seed in seeds]))


def summary(
    scenario: Scenario, runs: Sequence[RunOutcome], others: Mapping[str, Sequence[RunOutcome]] | None = None
) -> dict[str, Any]:
    """Return the summary of the runs of a scenario with one seed or several.

    With several, figures are means, their standard deviations (of a sample) are added, the digest is the SHA-256 over
    the digests of the runs, and expectations are judged by the means. A figure that some runs lack is the mean over the
    others.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    runs : sequence of Outcome
        One for each seed, in their order.
    others : mapping, optional
        Runs of its counterparts, whose figures are added to each expectation.

    Raises
    ------
    InputError
        If one of the runs could not be carried out.
    """
    for run in runs:
        if run.error:
            raise InputError(run.error)
    first, digests = runs[0], [run.digest for run in runs]
    digest = first.digest if len(runs) == 1 else hashlib.sha256("".join(digests).encode()).hexdigest()
    told = list(dict.fromkeys(text for run in runs for text in run.warnings))
    elapsed = sum(run.elapsed_s for run in runs)
    spread = _spread(runs)
    means = first.metrics if len(runs) == 1 else {name: mean for name, (mean, _) in spread.items()}
    beside_it = {
        kind: {name: mean for name, (mean, _) in _spread(other).items()} for kind, other in (others or {}).items()
    }
    pid = beside_it.get("pid", {})
    found = summarise(scenario, first.seed, first.ticks, elapsed, means, digest, first.stopped, told, pid)
    if len(runs) > 1:
        found |= {
            "seeds": [first.seed, runs[-1].seed],
            "digests": digests,
            "tripped_runs": sum(run.stopped is not None for run in runs),
            "metrics_std": {name: std for name, (_, std) in spread.items()},
        }
    if others is not None:
        for row, entry in zip(found["expectations"], scenario.head.expect, strict=True):
            row["open_loop"] = beside_it.get("open_loop", {}).get(entry.metric)
            row["pid"] = pid.get(entry.metric) if entry.compare == "pid" else None
            row["comparator"] = scenario.head.compared_with(entry)
            row["pid_too"] = entry.does_as_well(row["pid"])
    return found


def _spread(runs: Sequence[RunOutcome]) -> dict[str, tuple[float, float]]:
    """Return mean and standard deviation of every figure, as a campaign adds them up."""
    found = {}
    for name in sorted({name for run in runs for name in run.metrics}):
        moments, start = Moments(1), np.zeros(1, np.int64)
        moments.add(np.array([run.metrics[name] for run in runs if name in run.metrics]), start, start)
        (spread,) = moments.spreads()
        if spread is not None:
            found[name] = spread.mean, spread.std
    return found
