"""Carries a campaign out: computes in batches the runs that the table of results lacks, and puts them into it.

The table alone records progress. If a worker, the scheduler or this process dies, the runs in the table are never
computed again; the next process that resumes the campaign computes the missing ones. A single run is a campaign too,
which keeps the trace of its first run; that run comes last, when its report can use all other runs. As no campaign
keeps traces otherwise, it is computed for its trace even though the table has its outcome.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Any, Protocol

from core.compile.machine import WIDTH
from core.errors import InputError
from scenarios.campaign.batch import outcomes
from scenarios.campaign.executor import LOST, Processes
from scenarios.campaign.outcome import RunOutcome
from scenarios.campaign.points import Point
from scenarios.campaign.progress import Cancelled, tell
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.todo import Remaining, Run
from scenarios.key import code_version
from scenarios.run import DEFAULT_SAMPLES
from scenarios.schema import Scenario

if TYPE_CHECKING:
    from scenarios.campaign.cluster import Cluster

BATCH_S = 1.0
"""Computing time of a batch, long enough that the cost of sending it does not matter."""
MAX_BATCH = 512
AHEAD = 2
"""Batches under way for each worker."""
LOOK_S = 0.2
PATIENCE, ATTEMPTS = 5, 3
"""Losses in a row, without a result in between, after which a campaign fails, and a campaign that keeps a trace: where
both share processes, the single run is the likelier cause."""

Found = list[tuple[str, str]]
"""Outcomes as JSON, by the key of the run."""
Others = list[list[str]]
"""Outcomes of all runs but the first, point by point."""
_last: list[tuple[Point, Scenario]] = []
"""The point that this process has read last: the next one is read as a difference from it, in the next batch too."""


class ResultTable(Protocol):
    """The table of results."""

    def have(self, keys: Sequence[str]) -> set[str]:
        """Return the keys that are in the table."""

    def outcomes(self, keys: Sequence[str]) -> Iterable[tuple[str, str]]:
        """Return the stored outcomes of some keys."""

    def put(self, found: Found) -> None:
        """Add outcomes in one transaction; an outcome that the table has already stays as it is."""


class TraceKeeper(Protocol):
    """Keeps the trace of the first run of a campaign; it is called in a worker process, so it can be pickled."""

    def __call__(self, document: dict[str, Any], seed: int, others: Others) -> tuple[RunOutcome, Any]:
        """Carry the run out; return its outcome, and the additional result."""


class Stopped(Exception):
    """The campaign could not continue; the finished runs stay in the table."""


def compute(runs: list[Run], version: str) -> tuple[Found, float]:
    """Compute a batch; in a worker. Return the outcomes and the mean time of a run, s.

    A point that gives no valid scenario gives its error as the outcome of its runs.

    Raises
    ------
    RuntimeError
        When the worker runs another version of the code.
    """
    _check_version(version)
    began = time.perf_counter()
    read: dict[int, Scenario | InputError] = {}
    for _, point, _ in runs:
        if id(point) not in read:
            try:
                read[id(point)] = scenario = point.read(_last[0] if _last else None)
                _last[:] = [(point, scenario)]
            except InputError as error:
                read[id(point)] = error
    good: list[tuple[str, tuple[Scenario, int]]] = []
    found: list[tuple[str, RunOutcome]] = []
    for key, point, seed in runs:
        one = read[id(point)]
        if isinstance(one, InputError):
            found.append((key, RunOutcome(seed=seed, error=str(one))))
        else:
            good.append((key, (one, seed)))
    made = outcomes([run for _, run in good], tell)
    found += zip([key for key, _ in good], made, strict=True)
    return [(key, one.model_dump_json()) for key, one in found], (time.perf_counter() - began) / len(runs)


def compute_traced(trace: TraceKeeper, run: Run, others: Others, version: str) -> tuple[Found, float, Any]:
    """Carry out the run whose trace is kept; in a worker. Return its outcome, its time, and the additional result."""
    _check_version(version)
    key, point, seed = run
    found, kept = trace(point.document, seed, others)
    return [(key, found.model_dump_json())], found.elapsed_s, kept


def _check_version(version: str) -> None:
    if version != code_version():
        raise RuntimeError(f"the worker runs version {code_version()} of the code, the campaign is of {version}")


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
    processes : Processes, optional
        Processes of this machine that it shares with others instead.
    trace : Trace, optional
        Keeps the trace of the first run; `kept` is its return value.
    on_progress : callable
        Called after every batch, with the number of runs done and of all runs.
    """

    def __init__(
        self,
        sweep: Sweep,
        table: ResultTable,
        *,
        workers: int = 1,
        scheduler: str = "",
        processes: Processes | None = None,
        trace: TraceKeeper | None = None,
        on_progress: Callable[[int, int], None] = lambda _done, _all: None,
    ) -> None:
        self.sweep = sweep
        self.kept: Any = None
        self._table, self._on_progress = table, on_progress
        self._workers, self._scheduler, self._processes = workers, scheduler, processes
        self._trace = trace
        self._cost = BATCH_S
        self._remaining: Remaining | None = None
        self._pending: tuple[Future[Any], ...] = ()
        self._is_cancelled = False

    @property
    def total(self) -> int:
        """Different runs, as far as is known: points are compared in their turn."""
        return self._remaining.total if self._remaining is not None else 0

    @property
    def done(self) -> int:
        """Runs that are in the table, as far as is known: they are looked for in their turn."""
        return self._remaining.total - len(self._remaining) if self._remaining is not None else 0

    @property
    def progress(self) -> float:
        """Share of the ticks that are done; of runs under way they are known if processes are shared."""
        ticks = sum(self._processes.ticks(one) for one in self._pending) if self._processes is not None else 0
        done = self.done + ticks / (self.sweep.base.samples or DEFAULT_SAMPLES)
        return min(done / self.total, 1.0) if self.total else 0.0

    def cancel(self) -> None:
        """Stop at once; the runs in the table stay, those under way are lost."""
        self._is_cancelled = True

    def run(self) -> bool:
        """Compute the missing runs; return whether all runs are complete.

        Raises
        ------
        Stopped
            If there is no worker or no scheduler left.
        """
        remaining = self._remaining = Remaining(self.sweep, self._have)
        losses, lacks = 0, self._lacks(remaining)
        self._on_progress(self.done, self.total)
        while lacks:
            before = self.done
            try:
                with self._open() as executor:
                    self._work(executor, remaining)
            except LOST as error:
                losses = 1 if self.done > before else losses + 1
                if losses >= (PATIENCE if self._trace is None else ATTEMPTS):
                    lost = f"lost the scheduler at {self._scheduler}" if self._scheduler else "its processes died"
                    text = f"{lost} {losses} times in a row; {self.done} of {self.total} runs are done"
                    raise Stopped(text) from error
                time.sleep(min(2.0**losses, 10.0) / 4)
            lacks = self._lacks(remaining)
        return not remaining

    def _lacks(self, remaining: Remaining) -> bool:
        """Pass over the first runs that the table has; return whether there is something to do."""
        remaining.take_back()
        while remaining.waiting and not self._is_cancelled:
            if remaining.take(1):
                remaining.take_back()
                return True
        return False

    def _open(self) -> AbstractContextManager[Processes | Cluster]:
        if self._scheduler:
            from scenarios.campaign.cluster import open_cluster  # few campaigns go to a cluster

            return open_cluster(self._scheduler)
        return Processes(self._workers) if self._processes is None else nullcontext(self._processes)

    def _have(self, keys: Sequence[str]) -> set[str]:
        """Return the stored keys; the run whose trace is kept is computed in any case."""
        have = self._table.have(keys)
        return have if self._trace is None else have - {self.sweep.key(0)}

    def _work(self, executor: Processes | Cluster, remaining: Remaining) -> None:
        """Keep the workers busy until no run is left, and put results into the table as they arrive."""
        first = remaining.take(1)[0] if self._trace is not None else None
        pending: set[Future[Any]] = set()
        lost: BaseException | None = None
        try:
            while ((remaining.waiting or first) and not self._is_cancelled) or pending:
                try:
                    room = AHEAD * executor.width
                    while remaining.waiting and not self._is_cancelled and lost is None and len(pending) < room:
                        if batch := self._batch(remaining, executor.width):
                            pending.add(executor.submit(compute, batch, code_version()))
                    if first and not (remaining.waiting or pending or self._is_cancelled) and lost is None:
                        pending.add(self._submit_traced(executor, first))
                        first = None
                except LOST as error:
                    lost = error
                self._pending = tuple(pending)
                done, pending = wait(pending, LOOK_S, FIRST_COMPLETED)
                for future in done:
                    try:
                        self._take(remaining, *future.result())
                    except LOST as error:
                        lost = error
                    except Cancelled:
                        pass
                if lost is not None and not pending:
                    raise lost
                if self._is_cancelled:
                    for future in pending:
                        executor.stop(future)
        finally:
            for future in pending:
                executor.stop(future)

    def _batch(self, remaining: Remaining, width: int) -> list[Run]:
        """Take runs worth `BATCH_S` from the queue, towards its end ever fewer, so that all workers end together."""
        share = max(-(-remaining.waiting // (AHEAD * width)), WIDTH)
        count = min(max(1, round(BATCH_S / self._cost)), MAX_BATCH, share)
        return remaining.take(count - count % WIDTH or count)

    def _submit_traced(self, executor: Processes | Cluster, first: Run) -> Future[tuple[Found, float, Any]]:
        """Hand over the run whose trace is kept, with the outcomes of the others."""
        assert self._trace is not None
        keys = [self.sweep.key(number) for number in range(len(self.sweep))]
        texts = dict(self._table.outcomes(keys))
        count = len(self.sweep.seeds)
        others = [[texts[one] for one in keys[at : at + count] if one != first[0]] for at in range(0, len(keys), count)]
        return executor.submit(compute_traced, self._trace, first, others, code_version())

    def _take(self, remaining: Remaining, outcomes: Found, cost_s: float, kept: Any = None) -> None:
        """Put results into the table and update the cost of a run."""
        self._table.put(outcomes)
        self._cost = max(cost_s, 1e-6)
        self.kept = kept
        for key, _ in outcomes:
            remaining.finish(key)
        self._on_progress(self.done, self.total)
