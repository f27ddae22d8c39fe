"""Starting and stopping the service leaves nothing behind in its process: no file, no thread, little memory."""

from __future__ import annotations

import gc
import threading
from pathlib import Path

import psutil
import pytest

from tests.server.classroom.group import join, open_class
from tests.server.conftest import serving

MANY = pytest.param(50, 8, marks=[pytest.mark.long, pytest.mark.timeout(900)])
"""Starts, and starts that may still load permanent objects, such as modules and kernels."""


@pytest.mark.parametrize(("starts", "first"), [(3, 1), MANY])
def test_starts_leave_nothing_behind(tmp_path: Path, starts: int, first: int) -> None:
    process = psutil.Process()
    files: list[int] = []
    threads: list[int] = []
    memory: list[float] = []
    for number in range(starts):
        with serving(tmp_path / str(number % 2), run_workers=0) as live:
            bench = live.bench("first-look")["id"]
            with live.stream(bench) as stream:
                stream.until_type("hello")
            live.http.delete(f"/api/v1/benches/{bench}")
            group = open_class(live)
            with join(live, group, "Ada").stream() as stream:
                stream.until_type("hello")
            live.http.delete(f"/api/v1/classes/{group['id']}")
        gc.collect()
        files.append(process.num_fds())
        threads.append(threading.active_count())
        memory.append(process.memory_info().rss / 1e6)
    assert max(files[first:]) - files[first] <= 2, files
    assert max(threads[first:]) <= threads[first], threads
    # the remains of a start, without the reserve of the allocator for the next one
    if starts < 50:  # one start may need more, and the next ones no more than that
        return
    grown = sum(memory[-5:]) / 5 - sum(memory[first : first + 5]) / 5
    assert grown < 60.0, memory
