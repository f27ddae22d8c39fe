"""Starting and stopping the service leaves nothing behind in its process: no file, no thread, little memory."""

from __future__ import annotations

import gc
import threading
from pathlib import Path

import psutil
import pytest

from tests.server.conftest import serving
from tests.server.people.group import join, open_class

STARTS, FIRST = 50, 8
"""Starts, and those that may still load what stays, such as modules and kernels."""


@pytest.mark.long
@pytest.mark.timeout(900)
def test_fifty_starts_leave_nothing_behind(tmp_path: Path) -> None:
    process = psutil.Process()
    files: list[int] = []
    threads: list[int] = []
    memory: list[float] = []
    for number in range(STARTS):
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
    assert max(files[FIRST:]) - files[FIRST] <= 2, files
    assert max(threads[FIRST:]) <= threads[FIRST], threads
    # what a start leaves, and not what the allocator keeps for the next one
    grown = sum(memory[-5:]) / 5 - sum(memory[FIRST : FIRST + 5]) / 5
    assert grown < 60.0, memory
