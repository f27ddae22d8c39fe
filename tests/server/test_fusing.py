"""Benches that run for long take one function for each segment of a tick; nothing shows the moment."""

from __future__ import annotations

import asyncio
import logging
import os
import sys
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any
from weakref import WeakValueDictionary

import pytest

from core.board import segments
from core.compile.segment import code_of
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from server.bench import fusing
from tests.lab import do, play
from tests.server.conftest import Live

SWITCH = {"switch": "pid"}


@pytest.fixture(autouse=True)
def worth_it(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    """Forget loaded code and failures; benches are too short until `look` counts them as long."""
    monkeypatch.setattr(fusing, "LONG", 1 << 60)
    monkeypatch.setattr(fusing, "SHORT", 1 << 60)
    monkeypatch.setattr(segments, "_shared", WeakValueDictionary())
    monkeypatch.setattr(live.service.fusing, "_failed", set())
    monkeypatch.setattr(live.service.fusing, "_unkept", set())


@pytest.fixture
def here(live: Live, monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[str, Any]]:
    """Compile in this process; a test may say what happens meanwhile, or an error."""
    asked: dict[str, Any] = {"calls": 0, "error": None, "meanwhile": None}

    async def call(function: Any, steps: Any) -> Any:
        asked["calls"] += 1
        if asked["error"] is not None:
            raise asked["error"]
        if asked["meanwhile"] is not None:
            await asyncio.to_thread(asked["meanwhile"])
        return await asyncio.to_thread(function, steps)

    monkeypatch.setattr(live.service.fusing, "_computing", SimpleNamespace(call=call))
    yield asked


def bench_of(live: Live, **fields: Any) -> tuple[str, Any]:
    scenario = with_values(get("first-look"), {"events": [], "expect": []})
    bench = live.bench(scenario.document, **fields)["id"]
    return bench, live.service.benches.get(bench)


def look(live: Live, long: int = 0, short: int | None = None) -> None:
    """Look once, with benches that are long enough from some ticks on, for code that is kept from fewer on."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fusing, "LONG", long)
        patch.setattr(fusing, "SHORT", long if short is None else short)
        live.on_loop(live.service.fusing.look())


def straight(ticks: int, at: int = 0, command: dict[str, Any] | None = None) -> str:
    board = build(with_values(get("first-look"), {"events": [], "expect": []}))
    play(board, at)
    if command:
        do(board, command)
    play(board, ticks - at)
    return board.digest()


def test_a_bench_takes_the_code_that_another_process_has_compiled(live: Live) -> None:
    """The code comes from a process of its own; nothing that the bench tells says so."""
    bench, session = bench_of(live)
    live.advance(bench=bench, ticks=700)
    events, status = session.events.last, session.status
    look(live)
    assert session.board.fuses and not session.board.unfused
    assert (session.events.last, session.status) == (events, status)
    live.advance(bench=bench, ticks=700)
    assert len(session.board.walk.table) == 2
    assert session.board.digest() == straight(session.board.tick)


def test_a_switch_while_the_code_is_compiled_loses_no_tick(live: Live, here: dict[str, Any]) -> None:
    bench, session = bench_of(live)
    live.advance(bench=bench, ticks=700)
    at, rows, kinds = session.board.tick, len(session.board.walk.table), []

    def switched() -> None:
        if not kinds:
            kinds.append(live.command(bench, **SWITCH).json()["entry"]["kind"])
            assert len(session.board.walk.table) == rows > 2
            live.advance(bench=bench, ticks=400)

    here["meanwhile"] = switched
    look(live)
    assert session.board.tick == at + 400 and kinds == ["switch"]
    live.advance(bench=bench, ticks=700)
    assert len(session.board.walk.table) == 2
    assert session.board.digest() == straight(session.board.tick, at, SWITCH)


def test_code_that_cannot_be_compiled_is_one_line_of_the_log(
    live: Live, here: dict[str, Any], caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    here["error"] = RuntimeError("no room")
    bench, session = bench_of(live)
    live.advance(bench=bench, ticks=300)
    look(live)
    look(live)
    said = [one.message for one in caplog.records if "one by one" in one.message]
    assert len(said) == here["calls"] == len(session.board.unfused) and all("no room" in one for one in said)
    live.advance(bench=bench, ticks=300)
    assert session.board.digest() == straight(session.board.tick)


def test_only_benches_that_run_for_long_are_looked_at(live: Live, here: dict[str, Any]) -> None:
    _, paused = bench_of(live, paused=True)
    bench, short = bench_of(live)
    live.advance(bench=bench, ticks=300)
    look(live, short.board.tick + 1)
    assert not paused.board.fuses and not short.board.fuses and here["calls"] == 0


def test_a_shorter_bench_takes_the_code_that_is_kept_and_has_none_compiled(
    live: Live, here: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    kept: dict[Any, bytes] = {}
    monkeypatch.setattr(fusing, "kept_code_of", kept.get)
    bench, session = bench_of(live)
    live.advance(bench=bench, ticks=300)
    for _ in range(2):  # code that no shelf has is looked for once
        look(live, 1 << 60, 300)
        assert session.board.unfused and here["calls"] == len(session.board.unfused)
    monkeypatch.setattr(live.service.fusing, "_unkept", set())
    kept.update((segment.steps, code_of(segment.steps)) for segment in session.board.unfused)
    look(live, 1 << 60, 300)
    assert not session.board.unfused
    live.advance(bench=bench, ticks=300)
    assert session.board.digest() == straight(session.board.tick)


@pytest.mark.skipif(sys.platform != "linux", reason="the policy is of Linux")
def test_every_other_thread_comes_before_the_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fusing, "code_of", lambda _: bytes([os.sched_getscheduler(0)]))
    assert fusing.compiled_behind(()) == bytes([os.SCHED_IDLE])
    assert os.sched_getscheduler(0) == os.SCHED_OTHER


def test_benches_with_the_same_blocks_share_the_code(live: Live, here: dict[str, Any]) -> None:
    sessions = [bench_of(live)[1] for _ in range(2)]
    look(live)
    assert here["calls"] <= 2 and not any(session.board.unfused for session in sessions)
    first, second = ([part.segment for part in session.board.walk.parts] for session in sessions)
    assert first == second and code_of(first[0].steps)
