"""Worker processes: shared, told to stop in the middle of their work, made anew when one dies."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Iterator

import pytest

from scenarios.campaign.executor import LOST, Processes
from scenarios.campaign.signs import Cancelled, tell


def endless() -> None:
    """Work that has no end of its own."""
    ticks = 0
    while True:
        ticks += 1
        tell(ticks)


@pytest.fixture
def processes() -> Iterator[Processes]:
    with Processes(1) as found:
        yield found


def test_work_under_way_tells_its_ticks_and_ends_when_it_is_called_off(processes: Processes) -> None:
    first, second, third = (processes.submit(endless) for _ in range(3))
    end = time.monotonic() + 60
    while processes.ticks(first) < 1000:
        assert time.monotonic() < end
        time.sleep(0.01)
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


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere each process loads the code itself")
def test_processes_are_forked_from_one_of_their_own_and_that_one_is_replaced_too(processes: Processes) -> None:
    with Processes(1, niceness=7) as others:
        pid, parent = (processes.submit(function).result(60) for function in (os.getpid, os.getppid))
        assert parent != os.getpid() and others.submit(os.getppid).result(60) == parent
        assert others.submit(os.nice, 0).result(60) >= 7
    os.kill(parent, signal.SIGKILL)
    os.kill(pid, signal.SIGKILL)
    end = time.monotonic() + 60
    while True:
        try:
            assert processes.submit(os.getppid).result(60) not in (parent, os.getpid())
            return
        except LOST:
            assert time.monotonic() < end
            time.sleep(0.05)


def test_elsewhere_nobody_listens() -> None:
    tell(5)
