"""Kernels that are compiled while the server answers."""

from __future__ import annotations

import asyncio
import logging
import os
import sys
from pathlib import Path

import pytest

from core.compile import code
from scenarios import kernels
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from server import service
from server.runs import kernels as module
from server.runs.kernels import Kernels
from tests.lab import play

COMPILER = """#!{python} -S
import os, signal, sys
if os.fork() == 0:
    signal.pause()
open({pid!r}, "w").write(str(os.getpid()))
for done in range(1, 4):
    print(f"\\rCompiling kernels: {{done}} of 4", end="", flush=True)
{end}
"""


class Heard(logging.Handler):
    """Waits for a line of the log."""

    def __init__(self, words: str) -> None:
        super().__init__()
        self._words, self.heard = words, asyncio.Event()

    def emit(self, record: logging.LogRecord) -> None:
        if self._words in record.getMessage():
            self.heard.set()

    async def __aenter__(self) -> None:
        module.log.addHandler(self)

    async def __aexit__(self, *_: object) -> None:
        await asyncio.wait_for(self.heard.wait(), 60)
        module.log.removeHandler(self)


@pytest.fixture
def compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Put a program in the place of Python that says how far it is, with a process of its own; return its file."""

    def put(end: str) -> Path:
        pid, program = tmp_path / "pid", tmp_path / "python"
        program.write_text(COMPILER.format(python=sys.executable, pid=str(pid), end=end))
        program.chmod(0o700)
        monkeypatch.setattr("server.runs.kernels.sys.executable", str(program))
        monkeypatch.setattr(kernels, "complete", lambda: tmp_path / "complete")
        return pid

    return put


def runs(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


def test_progress_is_kept_and_no_process_outlives_the_server(compiler, caplog) -> None:
    pid = compiler("signal.pause()")
    caplog.set_level(logging.INFO)

    async def serve() -> int:
        loaded = Kernels()
        async with Heard("compiled 3 of 4"):
            await loaded.start()
            assert loaded.are_loaded
        assert (loaded.done, loaded.total) == (3, 4)
        group = int(pid.read_text())
        assert runs(group)
        await loaded.stop()
        return group

    group = asyncio.run(serve())
    while runs(group):
        os.sched_yield()


def test_kernels_that_cannot_be_compiled_ahead_are_a_warning(compiler) -> None:
    compiler("os.kill(0, 15)")

    async def serve() -> None:
        loaded = Kernels()
        async with Heard("could not be compiled ahead"):
            await loaded.start()
        await loaded.stop()

    asyncio.run(serve())


def test_nothing_is_compiled_that_is_kept_already(compiler, tmp_path: Path) -> None:
    pid = compiler("")
    (tmp_path / "complete").touch()

    async def serve() -> None:
        loaded = Kernels()
        await loaded.start()
        await loaded.compiled()
        await loaded.stop()

    asyncio.run(serve())
    assert not pid.exists()


def test_benches_go_on_with_code_for_this_processor_once_it_is_compiled(live, monkeypatch) -> None:
    """A board and its twin take other code of the same steps at a tick edge, and no bit differs."""
    scenario = with_values(get("first-look"), {"twins.other.controller.kind": "open_loop"})
    straight = build(scenario)
    play(straight, 800)
    bench = live.bench(scenario.document, paused=True)["id"]
    live.command(bench, "step", ticks=300)
    board = live.service.benches.get(bench).board

    def addresses() -> set[int]:
        return {address for one in (board, *board.twins.values()) for address in one.walk.table[:, 0]}

    async def compiled() -> None:
        assert addresses() == before, "it did not wait"

    before, steps = addresses(), {code.step(one.block).name for one in board.wiring.instances}
    monkeypatch.setattr(live.service.kernels, "compiled", compiled)
    for borrowed in (set(), steps):
        monkeypatch.setattr(code, "borrowed", borrowed)
        monkeypatch.setattr(service, "borrowed", borrowed)
        live.on_loop(live.service._use_own_code())
        assert (addresses() == before) is (not borrowed)
    assert not addresses() & before
    live.command(bench, "step", ticks=500)
    assert board.tick == 800 and board.digest() == straight.digest()
