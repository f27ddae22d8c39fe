"""The pulse of threads: blocked threads are distinguished from working threads by the data of the system."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from server.bench.pulse import Finger, Pulse

pytestmark = pytest.mark.skipif(
    not Path(f"/proc/self/task/{threading.get_native_id()}/schedstat").exists(),
    reason="this system does not tell what a thread does",
)


@contextmanager
def at(work: Callable[[threading.Event], object]) -> Iterator[threading.Thread]:
    """Let a thread work until the end."""
    over = threading.Event()
    thread = threading.Thread(target=work, args=(over,), daemon=True)
    thread.start()
    try:
        yield thread
    finally:
        over.set()
        thread.join(30)


def felt(*threads: threading.Thread, times: int = 20) -> list[Pulse]:
    """Feel a pulse some times; the first says nothing yet."""
    finger, found = Finger(), []
    for _ in range(times):
        found.append(finger.feel(threads, 0.005))
        time.sleep(0.005)
    return found[1:]


CROWD = """
import os, threading, time
from server.bench.pulse import Finger
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # one processor for all of this process
from numba import njit

@njit(nogil=True)
def spin(rounds):
    x = 0.0
    for i in range(rounds):
        x += (x + i) % 7.0
    return x

spin(1)
thread = threading.Thread(target=threading.Event().wait, daemon=True)
thread.start()
for _ in range(3):
    threading.Thread(target=spin, args=(1 << 40,), daemon=True).start()
finger, crowded, end = Finger(), 0, time.monotonic() + 30
while crowded < 5 and time.monotonic() < end:
    crowded += finger.feel([thread], 0.01).is_crowded
    time.sleep(0.01)
print("crowded" if crowded >= 5 else "never")
os._exit(0)
"""


def spin(over: threading.Event) -> None:
    while not over.is_set():
        pass


def test_a_thread_that_waits_for_nothing_in_particular_is_blocked() -> None:
    with at(lambda over: over.wait()) as thread:
        end = time.monotonic() + 30
        while not all(pulse.is_blocked for pulse in felt(thread)):
            assert time.monotonic() < end


def test_a_blocked_thread_is_crowded_while_others_want_more_processors_than_there_are() -> None:
    told = subprocess.run([sys.executable, "-c", CROWD], capture_output=True, text=True, timeout=60)
    assert told.stdout.split() == ["crowded"], told.stderr


def test_the_first_look_says_nothing() -> None:
    with at(lambda over: over.wait()) as thread:
        assert not Finger().feel([thread], 0.005).is_blocked


def test_a_thread_that_computes_is_at_work_and_its_time_counts() -> None:
    with at(spin) as thread:
        pulses = felt(thread, times=40)
    assert not any(pulse.is_blocked for pulse in pulses)
    assert 0.0 < sum(pulse.worked_s for pulse in pulses) <= 40 * 0.005


def test_of_several_threads_one_at_work_is_enough() -> None:
    with at(lambda over: over.wait()) as waits, at(spin) as works:
        assert not any(pulse.is_blocked for pulse in felt(waits, works))


def test_a_thread_for_which_another_works_is_at_work() -> None:
    for package in ("numba.core.compiler_lock", "pyarrow.parquet", "importlib._bootstrap"):
        names: dict[str, Any] = {"__name__": package}
        exec("def work(over): over.wait()", names)
        with at(names["work"]) as thread:
            assert not any(pulse.is_blocked for pulse in felt(thread)), package


def test_a_system_that_does_not_tell_blocks_nothing() -> None:
    thread = threading.Thread(target=print)  # never begun, so there is nothing to read of it
    assert felt(thread) == [Pulse(False, 0.005)] * 19
