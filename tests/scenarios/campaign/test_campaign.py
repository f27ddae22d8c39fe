"""A campaign gives what single runs give, wherever it is computed, and repeats nothing that is in the table."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Sequence
from concurrent.futures import Executor, Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from scenarios.campaign.campaign import Campaign, Stopped
from scenarios.campaign.outcome import RunOutcome
from scenarios.campaign.sweep import Sweep
from scenarios.run import run
from scenarios.schema import Scenario
from tests.scenarios.campaign.cluster import Cluster, free_port


class Memory:
    """A run table that remembers its entries, and their number."""

    def __init__(self) -> None:
        self.found: dict[str, RunOutcome] = {}
        self.puts: list[str] = []

    def have(self, keys: Sequence[str]) -> set[str]:
        return self.found.keys() & set(keys)

    def outcomes(self, keys: Sequence[str]) -> list[tuple[str, str]]:
        return [(key, self.found[key].model_dump_json()) for key in keys if key in self.found]

    def put(self, found: list[tuple[str, str]]) -> None:
        for key, entry in found:
            self.puts.append(key)
            self.found.setdefault(key, RunOutcome.model_validate_json(entry))


def small(count: int = 6, samples: int = 1500) -> Sweep:
    return Sweep(
        {
            "schema": 1,
            "scenario": "ch5-seven-step",
            "set": {"samples": samples},
            "seeds": {"count": count},
            "grid": {"sensor.noise_um": [0.05, 0.3]},
        }
    )


def digests(sweep: Sweep) -> dict[str, str]:
    return {key: run(Scenario.load(point.document), seed).digest for key, point, seed in sweep.runs()}


def test_processes_give_what_single_runs_give_and_nothing_is_run_twice() -> None:
    sweep, table, seen = small(), Memory(), list[tuple[int, int]]()
    assert Campaign(sweep, table, workers=2, on_progress=lambda *now: seen.append(now)).run()
    assert {key: found.digest for key, found in table.found.items()} == digests(sweep)
    assert len(table.puts) == 12 and seen[0] == (0, 12) and seen[-1] == (12, 12)
    # again: everything is stored, nothing is computed; with more seeds only the new runs
    assert Campaign(sweep, table, workers=1).run() and len(table.puts) == 12
    assert Campaign(small(7), table, workers=1).run() and len(table.puts) == 14


def test_what_another_has_put_into_the_table_meanwhile_is_not_computed() -> None:
    sweep, table = small(20, 9000), Memory()
    there = {key: RunOutcome(seed=seed) for key, _, seed in list(sweep.runs())[20:]}
    assert Campaign(
        sweep, table, workers=1, on_progress=lambda done, _: table.found.update(there) if done == 1 else None
    ).run()
    assert len(table.found) == 40 and 20 <= len(table.puts) <= 22  # a batch or two were under way


def test_a_run_that_cannot_be_carried_out_does_not_stop_the_others() -> None:
    document = {**small().document, "grid": {"events.0.severity": [0.05, 1e9]}, "seeds": {"count": 2}}
    table = Memory()
    assert Campaign(Sweep(document), table, workers=1).run()
    errors = [found.error for found in table.found.values() if found.error]
    assert len(table.found) == 4 and len(errors) == 2 and "severity" in errors[0]


def test_a_point_of_which_no_scenario_comes_does_not_stop_the_others() -> None:
    """Points are read when their runs are made: a faulty point is a result, and is not made again."""
    document = {**small().document, "grid": {"sensor.noise_um": [0.1, -1.0], "plant.model": ["linear", "none"]}}
    table, error = Memory(), RunOutcome(seed=2).error
    assert Campaign(Sweep(document), table, workers=1).run()
    said = [found.error for found in table.found.values()]
    assert len(said) == 24 and said.count(error) == 6
    assert any("sensor.noise_um" in text for text in said) and any("plant.model" in text for text in said)
    assert sorted({found.seed for found in table.found.values()}) == [1, 2, 3, 4, 5, 6]
    assert Campaign(Sweep(document), table, workers=1).run() and len(table.puts) == 24


def test_a_cancelled_campaign_keeps_what_is_done_and_goes_on_from_there() -> None:
    sweep, table = small(20, 9000), Memory()
    campaign = Campaign(sweep, table, workers=1, on_progress=lambda done, _: campaign.cancel() if done else None)
    assert not campaign.run()
    before = list(table.puts)
    assert 0 < len(before) < 40 and campaign.done == len(before)
    assert Campaign(sweep, table, workers=2).run()
    assert len(table.puts) == len(set(table.puts)) == 40 and table.puts[: len(before)] == before


class Unsteady(Executor):
    """Works at once, and loses the pieces of work with the given numbers, on their way in or out."""

    width = 2

    def __init__(self, lost: dict[int, str]) -> None:
        self.lost, self.pieces = lost, 0

    def submit(self, function: Any, /, *arguments: Any, **_: Any) -> Future[Any]:
        self.pieces += 1
        way = self.lost.get(self.pieces)
        if way == "in":
            raise ConnectionResetError("gone")
        answer: Future[Any] = Future()
        found = function(*arguments)
        if way == "out":
            answer.set_exception(BrokenProcessPool("died"))
        else:
            answer.set_result(found)
        return answer

    def stop(self, future: Future[Any]) -> None:
        future.cancel()


@pytest.fixture
def pauses(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The pauses that a campaign would make after a loss; none is made."""
    made: list[float] = []
    clock = SimpleNamespace(perf_counter=time.perf_counter, sleep=made.append)
    monkeypatch.setattr("scenarios.campaign.campaign.time", clock)
    return made


def test_a_piece_of_work_that_is_lost_is_computed_again_and_no_run_twice(
    monkeypatch: pytest.MonkeyPatch, pauses: list[float]
) -> None:
    sweep, table, executor = small(), Memory(), Unsteady({1: "out", 3: "in", 4: "out"})
    monkeypatch.setattr(Campaign, "_open", lambda _: nullcontext(executor))
    assert Campaign(sweep, table).run() and len(pauses) == 2
    assert len(table.puts) == len(set(table.puts)) == 12
    assert {key: found.digest for key, found in table.found.items()} == digests(sweep)


@pytest.mark.parametrize(
    ("scheduler", "lost"), [("", "its processes died"), ("tcp://a:1", "lost the scheduler at tcp://a:1")]
)
def test_after_losses_in_a_row_a_campaign_stops_and_tells_its_progress(
    monkeypatch: pytest.MonkeyPatch, pauses: list[float], scheduler: str, lost: str
) -> None:
    table, executor = Memory(), Unsteady(dict.fromkeys(range(2, 99), "out"))
    monkeypatch.setattr(Campaign, "_open", lambda _: nullcontext(executor))
    with pytest.raises(Stopped, match=rf"{lost} 5 times in a row; \d+ of 12 runs are done"):
        Campaign(small(), table, scheduler=scheduler).run()
    assert 0 < len(table.puts) == len(set(table.puts)) < 12 and pauses == sorted(pauses)


@pytest.mark.long
def test_a_worker_process_that_is_killed_is_replaced() -> None:
    sweep, table, killed = small(20, 9000), Memory(), list[tuple[int, int]]()

    def kill_one_worker(done: int, runs: int) -> None:
        if done and not killed:
            killed.append((done, runs))
            os.kill(multiprocessing.active_children()[0].pid or 0, signal.SIGKILL)

    assert Campaign(sweep, table, workers=2, on_progress=kill_one_worker).run()
    assert killed[0][0] < killed[0][1] == 40
    assert len(table.puts) == len(set(table.puts)) == 40
    assert {key: found.digest for key, found in table.found.items()} == digests(sweep)


@pytest.mark.long
def test_without_a_scheduler_a_campaign_stops_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("scenarios.campaign.campaign.PATIENCE", 2)
    monkeypatch.setattr("scenarios.campaign.cluster.CONNECT_S", 0.2)
    with pytest.raises(Stopped, match=r"lost the scheduler at tcp://127.0.0.1.* 0 of 12"):
        Campaign(small(), Memory(), scheduler=f"tcp://127.0.0.1:{free_port()}").run()


@pytest.mark.long
@pytest.mark.timeout(900)
def test_a_batch_that_is_done_but_cannot_be_fetched_is_computed_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As when the scheduler goes while it hands over the result of a worker."""
    from distributed import Client

    gather, failed = Client._gather, list[bool]()

    async def gather_at_last(self: Client, *arguments: Any, **named: Any) -> Any:
        if not failed:
            failed.append(True)
            raise ConnectionResetError("gone")
        return await gather(self, *arguments, **named)

    monkeypatch.setattr(Client, "_gather", gather_at_last)
    sweep, table = small(), Memory()
    with Cluster(tmp_path) as cluster:
        cluster.start_worker()
        campaign = Campaign(sweep, table, scheduler=cluster.address)
        thread = threading.Thread(target=campaign.run, daemon=True)
        thread.start()
        thread.join()
        assert failed
    assert len(table.puts) == len(set(table.puts)) == 12


@pytest.mark.long
def test_a_campaign_on_a_cluster_is_cancelled(tmp_path: Path) -> None:
    table = Memory()
    with Cluster(tmp_path) as cluster:
        cluster.start_worker()
        campaign = Campaign(
            small(50, 9000),
            table,
            scheduler=cluster.address,
            on_progress=lambda done, _: campaign.cancel() if done else None,
        )
        assert not campaign.run()
    assert 0 < len(table.puts) == campaign.done < 100


@pytest.mark.long
@pytest.mark.timeout(900)
def test_a_cluster_gives_what_single_runs_give_though_worker_and_scheduler_are_killed(tmp_path: Path) -> None:
    sweep, table = small(100, 4000), Memory()
    with Cluster(tmp_path) as cluster:
        first = [cluster.start_worker(), cluster.start_worker()]
        progress = threading.Condition()

        def told(_done: int, _all: int) -> None:
            with progress:
                progress.notify_all()

        campaign = Campaign(sweep, table, scheduler=cluster.address, on_progress=told)
        thread = threading.Thread(target=campaign.run, daemon=True)
        thread.start()

        def until(done: int) -> None:
            with progress:
                progress.wait_for(lambda: campaign.done >= done and table.puts)

        until(2)
        first[0].kill()
        until(20)
        at_the_loss = list(table.puts)
        cluster.scheduler.kill()
        cluster.scheduler.wait()
        for worker in cluster.workers:
            worker.kill()
            worker.wait()
        cluster.start_scheduler()
        cluster.start_worker()
        thread.join()
    assert len(at_the_loss) < 200
    assert len(table.puts) == len(set(table.puts)) == len(table.found) == 200
    some = dict(list(digests(small(100, 4000)).items())[::20])
    assert {key: table.found[key].digest for key in some} == some
