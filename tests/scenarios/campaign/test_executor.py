"""Worker processes: shared, stopped in the middle of their work, made anew when one dies."""

from __future__ import annotations

import asyncio
import os
import pickle
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from core.wall import wall
from scenarios.campaign.cluster import Cluster
from scenarios.campaign.executor import LOST, Processes
from scenarios.campaign.progress import Cancelled, tell


def endless(begun: str = "") -> None:
    """Work that has no end of its own; it opens and closes a pipe after a thousand ticks."""
    ticks = 0
    while True:
        ticks += 1
        tell(ticks)
        if begun and ticks == 1000:
            Path(begun).open("wb").close()


@pytest.fixture
def processes() -> Iterator[Processes]:
    with Processes(1) as found:
        yield found


def test_work_under_way_tells_its_ticks_and_ends_when_it_is_called_off(processes: Processes, tmp_path: Path) -> None:
    begun = tmp_path / "begun"
    os.mkfifo(begun)
    first, second, third = (processes.submit(endless, str(begun)) for _ in range(3))
    assert begun.read_bytes() == b"" and processes.ticks(first) >= 1000
    assert processes.ticks(second) == processes.ticks(third) == 0
    for waiting in (second, third):  # one of them has been handed to the process already
        processes.stop(waiting)
    assert not first.done()
    processes.stop(first)
    with pytest.raises(Cancelled):
        first.result(60)
    assert processes.submit(os.getpid).result(60) != os.getpid()
    assert second.done() and third.done()
    assert processes.ticks(first) == 0


def test_after_a_process_died_there_are_others(processes: Processes) -> None:
    pid = processes.submit(os.getpid).result(60)
    work = processes.submit(endless)
    os.kill(pid, signal.SIGKILL)
    assert isinstance(work.exception(60), LOST)
    assert processes.submit(os.getpid).result(60) != pid


FORKED = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere each process loads the code itself")


@FORKED
def test_processes_are_forked_from_one_of_their_own_with_their_niceness(processes: Processes) -> None:
    parent = processes.submit(os.getppid).result()
    with Processes(1, niceness=7) as others:
        assert parent != os.getpid() and others.submit(os.getppid).result() == parent
        assert others.submit(os.nice, 0).result() >= 7


@FORKED
@pytest.mark.long
def test_the_process_that_others_are_forked_from_is_replaced_too(processes: Processes) -> None:
    pid, parent = (processes.submit(function).result() for function in (os.getpid, os.getppid))
    for number in (parent, pid):
        os.kill(number, signal.SIGKILL)
    while True:
        try:
            assert processes.submit(os.getppid).result() not in (parent, os.getpid())
            return
        except LOST:
            pass


def test_elsewhere_nobody_listens() -> None:
    tell(5)


def test_processes_of_a_server_with_a_wall_have_it_too() -> None:
    wall.demand()
    try:
        with Processes(1) as found:
            assert found.submit(wall.is_demanded).result(60)
    finally:
        wall.demand(False)
    with Processes(1) as found:
        assert not found.submit(wall.is_demanded).result(60)


def test_pieces_of_work_take_the_wall_along_to_a_cluster() -> None:
    """Each piece is done as a worker would do it, which has never heard of the wall."""

    class Client:
        told: Any = None

        def submit(self, function: Any, *arguments: Any, **_: Any) -> Any:
            self.told = pickle.loads(pickle.dumps(function)), arguments
            raise OSError("this is as far as it goes")

    try:
        for wanted in (True, False):
            client = Client()
            wall.demand(wanted)
            with pytest.raises(OSError, match="as far"):
                Cluster(client).submit(wall.is_demanded)
            wall.demand(False)
            function, arguments = client.told
            assert function(*arguments) is wanted
    finally:
        wall.demand(False)


class Task:
    """A piece of work on a cluster that ends with a value, or with the loss of it."""

    def __init__(self, ends: Any) -> None:
        self.ends, self.is_cancelled = ends, False

    def __await__(self) -> Iterator[Any]:
        yield from ()
        if isinstance(self.ends, Exception):
            raise self.ends
        return self.ends

    def cancel(self) -> None:
        self.is_cancelled = True


def test_a_cluster_answers_for_every_piece_of_work_also_when_it_cannot_be_fetched() -> None:
    from distributed.client import ClosedClientError

    later: list[Any] = []
    client = SimpleNamespace(loop=SimpleNamespace(add_callback=later.append), nthreads=lambda: {"a": 2, "b": 1})
    cluster = Cluster(client)
    lost = ConnectionResetError("gone")
    for task in (Task(5), Task(lost), called_off := Task(5)):
        client.submit = lambda *_, task=task, **__: task
        answer = cluster.submit(os.getpid)
        if task is called_off:
            cluster.stop(answer)
        asyncio.run(later.pop()())
        if task is called_off:
            assert answer.cancelled()
        elif task.ends is lost:
            assert answer.exception() is lost
        else:
            assert answer.result() == 5
    assert called_off.is_cancelled and cluster.width == 3

    def closed(*_: Any, **__: Any) -> None:
        raise ClosedClientError("closed")

    client.submit = closed
    with pytest.raises(ConnectionError, match="closed"):
        cluster.submit(os.getpid)
    client.nthreads, client.status = (lambda: {}), "closed"
    assert cluster.width == 1
    client.nthreads = lambda: client.scheduler.nthreads()
    with pytest.raises(ConnectionError, match="the client of the scheduler is closed"):
        _ = cluster.width
