"""Carries a campaign out: computes in batches the runs that the run table lacks, and puts them into it.

The table alone records progress. If a worker, the scheduler or this process dies, the runs in the table are never
computed again; the next process that resumes the campaign computes the missing ones.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from statistics import fmean
from typing import Any, Protocol

from scenarios.campaign.batch import outcomes
from scenarios.campaign.executor import LOST, open_executor, width_of
from scenarios.campaign.remaining import Remaining
from scenarios.campaign.sweep import Sweep
from scenarios.key import code_version
from scenarios.schema import Scenario

BATCH_S = 1.0
"""Computing time of a batch, long enough that the cost of sending it does not matter."""
MAX_BATCH = 500
AHEAD = 2
"""Batches under way for each worker."""
LOOK_S = 0.2
PATIENCE = 5
"""Number of losses in a row, without a result in between, after which a campaign gives up."""

Task = tuple[str, dict[str, Any], int]
Found = list[tuple[str, str]]
"""Outcomes as JSON, by the key of the run."""


class Table(Protocol):
    """The run table."""

    def have(self, keys: Sequence[str]) -> set[str]:
        """Return the keys that are in the table."""

    def put(self, found: Found) -> None:
        """Add outcomes in one transaction; an outcome that the table has already stays as it is."""


class Stopped(Exception):
    """The campaign could not go on; the finished runs stay in the table."""


def compute(tasks: list[Task], version: str) -> tuple[Found, float]:
    """Compute a batch; in a worker. Return the outcomes and the mean time of a run, s.

    Raises
    ------
    RuntimeError
        When the worker runs another version of the code.
    """
    if version != code_version():
        raise RuntimeError(f"the worker runs version {code_version()} of the code, the campaign is of {version}")
    read: dict[int, Scenario] = {}
    scenario = None
    for _, document, _ in tasks:
        if id(document) not in read:
            read[id(document)] = scenario = Scenario.load(document, like=scenario)
    found = outcomes([(read[id(document)], seed) for _, document, seed in tasks])
    texts = [(key, outcome.model_dump_json()) for (key, _, _), outcome in zip(tasks, found, strict=True)]
    return texts, fmean(outcome.elapsed_s for outcome in found)


class Campaign:
    """A campaign under way.

    Parameters
    ----------
    sweep : Sweep
        The campaign to run.
    table : Table
        The table of results, which also takes new ones.
    workers : int
        Processes of this machine.
    scheduler : str
        Address of a Dask scheduler instead.
    niceness : int
        Niceness of the processes.
    on_progress : callable
        Called after every batch, with the number of runs done and of all runs.
    """

    def __init__(
        self,
        sweep: Sweep,
        table: Table,
        *,
        workers: int = 1,
        scheduler: str = "",
        niceness: int = 0,
        on_progress: Callable[[int, int], None] = lambda _done, _all: None,
    ) -> None:
        self.sweep, self.total = sweep, 0
        self._table, self._on_progress = table, on_progress
        self._workers, self._scheduler, self._niceness = workers, scheduler, niceness
        self._cost = BATCH_S
        self._remaining: Remaining | None = None
        self._is_cancelled = self._is_abandoned = False

    @property
    def done(self) -> int:
        """Runs that are in the table."""
        return self.total - len(self._remaining) if self._remaining is not None else 0

    def cancel(self) -> None:
        """Stop after the batches under way; finished runs stay."""
        self._is_cancelled = True

    def abandon(self) -> None:
        """Stop at once; the runs under way are lost, and the next process that resumes the campaign computes them."""
        self._is_cancelled = self._is_abandoned = True

    def run(self) -> bool:
        """Compute the missing runs; return whether all runs are there.

        Raises
        ------
        Stopped
            If there is no worker or no scheduler left.
        """
        remaining = self._remaining = Remaining(self.sweep, self._table.have)
        self.total = remaining.total
        self._on_progress(self.done, self.total)
        losses = 0
        while remaining and not self._is_cancelled:
            before = self.done
            try:
                with open_executor(self._workers, self._scheduler, self._niceness) as executor:
                    self._work(executor, remaining)
            except LOST as error:
                losses = 1 if self.done > before else losses + 1
                if losses >= PATIENCE:
                    where = f"the scheduler at {self._scheduler}" if self._scheduler else "worker processes"
                    text = f"lost {where} {losses} times in a row; {self.done} of {self.total} runs are done"
                    raise Stopped(text) from error
                time.sleep(min(2.0**losses, 10.0) / 4)
        return not remaining

    def _work(self, executor: Executor, remaining: Remaining) -> None:
        """Keep the workers busy until no run is left, and put results into the table as they arrive."""
        remaining.take_back()
        pending: set[Future[tuple[Found, float]]] = set()
        lost: BaseException | None = None
        while (remaining.waiting and not self._is_cancelled) or pending:
            try:
                width = width_of(executor, self._workers)
                while remaining.waiting and not self._is_cancelled and lost is None and len(pending) < AHEAD * width:
                    pending.add(executor.submit(compute, self._batch(remaining, width), code_version()))
            except LOST as error:
                lost = error
            done, pending = wait(pending, LOOK_S, FIRST_COMPLETED)
            for future in done:
                try:
                    self._take(remaining, *future.result())
                except LOST as error:
                    lost = error
            if lost is not None and not pending:
                raise lost
            if self._is_cancelled:
                for future in pending:
                    future.cancel()
            if self._is_abandoned:
                for process in list((getattr(executor, "_processes", None) or {}).values()):
                    process.kill()
                return

    def _batch(self, remaining: Remaining, width: int) -> list[Task]:
        """Take runs worth `BATCH_S` from the queue, fewer if some worker would otherwise get none."""
        size = min(max(1, round(BATCH_S / self._cost)), MAX_BATCH, -(-remaining.waiting // width))
        chosen = remaining.take(size)
        points = {id(point): point for _, point, _ in chosen}
        documents = {number: point.document for number, point in points.items()}
        return [(key, documents[id(point)], seed) for key, point, seed in chosen]

    def _take(self, remaining: Remaining, outcomes: Found, cost_s: float) -> None:
        """Put results into the table and update the cost of a run."""
        self._table.put(outcomes)
        self._cost = max(cost_s, 1e-6)
        for key, _ in outcomes:
            remaining.finish(key)
        self._on_progress(self.done, self.total)
