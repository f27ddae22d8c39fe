"""Kernels that are compiled while the server answers."""

from __future__ import annotations

import asyncio
import os
import sys
import time
from pathlib import Path

import pytest

from scenarios import kernels
from server.kernels import Kernels

COMPILER = """#!{python} -S
import os, sys, time
if os.fork() == 0:
    time.sleep(60)
open({pid!r}, "w").write(str(os.getpid()))
for done in range(1, 4):
    print(f"\\rCompiling kernels: {{done}} of 4", end="", flush=True)
    time.sleep(0.05)
{end}
"""


@pytest.fixture
def compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Put a program in the place of Python that says how far it is, with a process of its own; return its file."""

    def put(end: str) -> Path:
        pid, program = tmp_path / "pid", tmp_path / "python"
        program.write_text(COMPILER.format(python=sys.executable, pid=str(pid), end=end))
        program.chmod(0o700)
        monkeypatch.setattr("server.kernels.sys.executable", str(program))
        monkeypatch.setattr(kernels, "complete", lambda: tmp_path / "complete")
        return pid

    return put


def runs(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


async def until(condition, seconds: float = 20.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        await asyncio.sleep(0.02)


def test_progress_is_kept_and_no_process_outlives_the_server(compiler) -> None:
    pid = compiler("time.sleep(60)")

    async def serve() -> int:
        loaded = Kernels()
        await loaded.start()
        assert loaded.are_loaded
        await until(lambda: loaded.done == 3)
        assert loaded.total == 4
        group = int(pid.read_text())
        assert runs(group)
        await loaded.stop()
        return group

    group = asyncio.run(serve())
    end = time.monotonic() + 20
    while runs(group):
        assert time.monotonic() < end
        time.sleep(0.02)


def test_kernels_that_cannot_be_compiled_ahead_are_a_warning(compiler, caplog) -> None:
    compiler("os.kill(0, 15)")

    async def serve() -> None:
        loaded = Kernels()
        await loaded.start()
        await until(lambda: "cannot be" in caplog.text or "could not be" in caplog.text)
        await loaded.stop()

    asyncio.run(serve())


def test_nothing_is_compiled_that_is_kept_already(compiler, tmp_path: Path) -> None:
    pid = compiler("")
    (tmp_path / "complete").touch()

    async def serve() -> None:
        loaded = Kernels()
        await loaded.start()
        await asyncio.sleep(0.3)
        await loaded.stop()

    asyncio.run(serve())
    assert not pid.exists()
