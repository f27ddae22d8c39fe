"""Outputs go to their safe values on the thread of the engine, whichever thread sees that it hangs."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from server.bench import watchdog
from server.bench.bench import LiveBench
from server.bench.engine import Engine
from server.bench.watchdog import Safety
from server.metrics import Metrics
from tests.server.bench.test_session import session


def test_the_thread_of_the_engine_takes_the_outputs_to_safe_values(monkeypatch: pytest.MonkeyPatch) -> None:
    threads: list[Any] = []
    make_safe = watchdog.make_safe

    def noted(bench: LiveBench, reason: str) -> None:
        threads.append(threading.current_thread())
        make_safe(bench, reason)

    monkeypatch.setattr(watchdog, "make_safe", noted)
    unused: Any = None
    engine, bench = Engine(Metrics(), lambda: None), session("first-look")
    careful = Safety(engine, unused, unused, Metrics(), unused, unused, unused)
    careful.hung([bench], [], "the engine broke off")
    assert bench.status.state == "tripped" and bench.board.trip is None and threads == []
    engine.start()
    engine.submit(lambda: None).result(30)  # urgent jobs are done before it
    engine.stop()
    assert [thread.name for thread in threads] == ["combbench-engine"]
    assert bench.board.trip is not None and bench.board.value("drive.voltage") == 0.0
