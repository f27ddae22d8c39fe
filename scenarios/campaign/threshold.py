"""Thresholds: over the range of one number of a scenario, where a claim begins to hold, and where it ceases to."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from core.errors import InputError, unknown
from core.format import format_short
from scenarios.campaign.campaign import Campaign, Found
from scenarios.campaign.campaign import ResultTable as Results
from scenarios.campaign.check import check
from scenarios.campaign.executor import Processes
from scenarios.campaign.halving import ROUNDS, Halving, ThresholdGoal
from scenarios.campaign.outcome import RunOutcome
from scenarios.campaign.sweep import Sweep
from scenarios.claims import holds
from scenarios.edit import with_values
from scenarios.expectation import Expectation
from scenarios.run import build
from scenarios.schema import Scenario


class ResultMemory:
    """A table of results that lasts as long as its process."""

    def __init__(self) -> None:
        self._rows: dict[str, str] = {}

    def have(self, keys: Sequence[str]) -> set[str]:
        """Return the keys that are in the table."""
        return {key for key in keys if key in self._rows}

    def outcomes(self, keys: Sequence[str]) -> Iterable[tuple[str, str]]:
        """Return the stored outcomes of some keys."""
        return [(key, self._rows[key]) for key in keys if key in self._rows]

    def put(self, found: Found) -> None:
        """Add outcomes."""
        self._rows.update(found)


def claim_of(scenario: Scenario, metric: str) -> Expectation:
    """Return the expectation of a scenario about a metric.

    Raises
    ------
    InputError
        When there is none.
    """
    for entry in scenario.head.expect:
        if entry.metric == metric:
            return entry
    raise unknown("claim", metric, [entry.metric for entry in scenario.head.expect], "metric")


class Search(Campaign):
    """A campaign whose points follow from each other: the grid, then the halves; `kept` is the result.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    wanted : Wanted
        The claim and the number.
    table, workers, processes, on_progress
        As for a campaign.

    Raises
    ------
    InputError
        When the scenario has no such claim or no such number, or an end of the range is not allowed.
    """

    def __init__(
        self,
        scenario: Scenario,
        wanted: ThresholdGoal,
        table: Results,
        *,
        workers: int = 1,
        processes: Processes | None = None,
        on_progress: Callable[[int, int], None] = lambda _done, _all: None,
    ) -> None:
        entry = claim_of(scenario, wanted.metric)
        for field in ("low", "high"):
            try:
                build(with_values(scenario, {wanted.path: getattr(wanted, field)}))
            except InputError as error:
                raise InputError(f"{wanted.path}: {error.message}", field, error.hint) from None
        self._scenario, self._wanted = scenario, wanted
        self._halving = Halving(wanted, lambda measured: holds(entry, measured))
        self._values = self._halving.next()
        self._earlier = 0
        super().__init__(self._sweep(), table, workers=workers, processes=processes, on_progress=on_progress)
        check(self.sweep)

    @property
    def total(self) -> int:
        """Runs so far, including this round."""
        return self._earlier + super().total

    @property
    def done(self) -> int:
        """Runs that are done."""
        return self._earlier + super().done

    @property
    def progress(self) -> float:
        """Share of the search that is done: the grid is one half of it, all rounds after it are the other."""
        rounds = self._halving.rounds
        share = super().done / super().total if super().total else 0.0
        return 0.5 * share if rounds == 0 else min(1.0, 0.5 + 0.5 * (rounds - 1 + share) / ROUNDS)

    def run(self) -> bool:
        """Search until all thresholds are found; return whether they are."""
        while super().run():
            self._halving.take(self._measured())
            self.kept = json.loads(self._halving.found().model_dump_json())
            self._values = self._halving.next()
            if not self._values:
                return True
            self._earlier += super().total
            self.sweep = self._sweep()
        return False

    def _sweep(self) -> Sweep:
        """Return the runs of a round."""
        seed = self._scenario.spec.seed
        return Sweep(
            {
                "id": "threshold",
                "scenario": self._scenario.document,
                "grid": {self._wanted.path: self._values},
                "seeds": f"{seed}:{seed}",
            }
        )

    def _measured(self) -> list[tuple[float, float | None]]:
        """Return the figures of a round."""
        keys = [self.sweep.key(number) for number in range(len(self.sweep))]
        texts: dict[str, Any] = dict(self._table.outcomes(keys))
        found = []
        for value, key in zip(self._values, keys, strict=True):
            one = RunOutcome.model_validate_json(texts[key])
            if one.error:
                raise InputError(f"{self._wanted.path} = {format_short(value, '', 4)}: {one.error}", "path")
            found.append((value, one.metrics.get(self._wanted.metric)))
        return found
