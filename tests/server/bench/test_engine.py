"""The engine: everyone gets a turn, jobs run between slices, one failure stays alone."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Iterator

import pytest

from server.bench.engine import PERIOD_S, Engine
from server.clock import ManualClock
from server.metrics import Metrics


class Work:
    """A bench that only counts."""

    def __init__(self, name: str, rate: float | None, clock: Callable[[], float]) -> None:
        self.id, self._rate, self._clock = name, rate, clock
        self.is_running, self.is_hurried, self.tick, self.rounds = True, False, 0, 0
        self.failed: Exception | None = None
        self._start = clock()
        self.breaks_at = 10**12

    @property
    def time(self) -> Work:
        return self

    def target(self, now: float) -> int | None:
        return None if self._rate is None else int((now - self._start) * self._rate)

    def slice(self, target: int | None) -> bool:
        if self.tick >= self.breaks_at:
            raise RuntimeError("broken on purpose")
        self.tick = self.tick + 512 if target is None else min(target, self.tick + 512)
        return target is None or self.tick < target

    def finish_round(self, target: int | None, now: float) -> None:
        self.rounds += 1

    def fail(self, error: Exception) -> None:
        self.failed, self.is_running = error, False


def until(holds: Callable[[], bool]) -> None:
    """Let other threads work until something holds."""
    while not holds():
        os.sched_yield()


def turn(engine: Engine, rounds: int) -> None:
    """Let the time of so many rounds pass."""

    async def passes() -> None:
        for _ in range(rounds):
            await engine.clock.advance(engine.clock() + PERIOD_S)  # type: ignore[attr-defined]
            await engine.settle()

    asyncio.run(passes())


@pytest.fixture
def engine() -> Iterator[Engine]:
    found = Engine(Metrics(), lambda: None, ManualClock())
    found.start()
    yield found
    found.stop()


def test_paced_benches_keep_their_rate_beside_a_free_one(engine: Engine) -> None:
    works = [Work(str(n), 50_000.0, engine.clock) for n in range(4)] + [Work("free", None, engine.clock)]
    for work in works:
        engine.submit(engine.add, work).result(5)
    turn(engine, 60)
    assert [work.tick for work in works[:4]] == [work.target(engine.clock()) for work in works[:4]]
    assert works[0].tick == pytest.approx(25_000, abs=1) and works[4].tick >= 60 * 512


def test_a_job_is_done_between_two_slices_and_its_result_awaited() -> None:
    engine = Engine(Metrics(), lambda: None)
    engine.start()
    work = Work("busy", None, engine.clock)
    engine.submit(engine.add, work).result(5)
    until(lambda: work.tick > 0)
    assert asyncio.run(engine.call(lambda: work.tick)) % 512 == 0
    engine.stop()


def test_a_job_is_done_while_nothing_runs(engine: Engine) -> None:
    assert engine.submit(lambda: 42).result(2) == 42
    with pytest.raises(ZeroDivisionError):
        engine.submit(lambda: 1 / 0).result(2)
    assert engine.is_alive


def test_a_failure_stops_that_bench_alone(engine: Engine) -> None:
    good, bad = Work("good", 10_000.0, engine.clock), Work("bad", 10_000.0, engine.clock)
    bad.breaks_at = 1000
    for work in (good, bad):
        engine.submit(engine.add, work).result(5)
    turn(engine, 60)
    assert isinstance(bad.failed, RuntimeError) and 1000 <= bad.tick < 2000
    assert good.failed is None and good.tick == good.target(engine.clock())
    assert engine.is_alive


def test_after_the_end_nothing_is_taken() -> None:
    engine = Engine(Metrics(), lambda: None)
    engine.start()
    waiting = [engine.submit(lambda: 1) for _ in range(20)]
    engine.stop()
    assert all(job.done() for job in waiting)
    assert not engine.is_alive
    with pytest.raises(RuntimeError, match="stopped"):
        engine.submit(lambda: 1)
