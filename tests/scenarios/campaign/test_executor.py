"""Worker processes: shared, told to stop in the middle of their work, made anew when one dies."""

from __future__ import annotations

import os
import pickle
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from core.wall import wall
from scenarios.campaign.cluster import Cluster
from scenarios.campaign.executor import LOST, Processes
from scenarios.campaign.signs import Cancelled, tell


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


@pytest.mark.long
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere each process loads the code itself")
def test_processes_are_forked_from_one_of_their_own_and_that_one_is_replaced_too(processes: Processes) -> None:
    with Processes(1, niceness=7) as others:
        pid, parent = (processes.submit(function).result(60) for function in (os.getpid, os.getppid))
        assert parent != os.getpid() and others.submit(os.getppid).result(60) == parent
        assert others.submit(os.nice, 0).result(60) >= 7
    os.kill(parent, signal.SIGKILL)
    os.kill(pid, signal.SIGKILL)
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
