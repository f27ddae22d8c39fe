"""The pulse of threads: blocked threads are distinguished from working threads by the data of the system."""

from __future__ import annotations

import os
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

ROOT = Path(__file__).resolve().parents[3]

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
import numpy as np
from core.kernel import kernel

@kernel
def spin(x, rounds):
    for i in range(rounds):
        x[0] += (x[0] + i) % 7.0

spin(np.zeros(1), 1)
thread = threading.Thread(target=threading.Event().wait, daemon=True)
thread.start()
for _ in range(3):
    threading.Thread(target=spin, args=(np.zeros(1), 1 << 40), daemon=True).start()
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


def test_a_blocked_thread_is_crowded_while_others_want_more_processors_than_there_are(tmp_path: Path) -> None:
    (tmp_path / "crowd.py").write_text(CROWD, "utf-8")
    command = [sys.executable, str(tmp_path / "crowd.py")]
    around = {**os.environ, "PYTHONPATH": str(ROOT)}
    told = subprocess.run(command, capture_output=True, text=True, timeout=60, env=around)
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
    for package in ("llvmlite.binding.ffi", "pyarrow.parquet", "importlib._bootstrap"):
        names: dict[str, Any] = {"__name__": package}
        exec("def work(over): over.wait()", names)
        with at(names["work"]) as thread:
            assert not any(pulse.is_blocked for pulse in felt(thread)), package


def test_a_system_that_does_not_tell_blocks_nothing() -> None:
    thread = threading.Thread(target=print)  # never begun, so there is nothing to read of it
    assert felt(thread) == [Pulse(False, 0.005)] * 19
