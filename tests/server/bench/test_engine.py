"""The engine: everyone gets a turn, jobs run between slices, one failure stays alone."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterator

import pytest

from server.bench.engine import Engine
from server.metrics import Metrics


class Work:
    """A bench that only counts."""

    def __init__(self, name: str, rate: float | None, clock: Callable[[], float], cost: float = 0.0) -> None:
        self.id, self._rate, self._clock, self._cost = name, rate, clock, cost
        self.is_running, self.tick, self.rounds = True, 0, 0
        self.failed: Exception | None = None
        self._start = clock()
        self.breaks_at = 10**12

    def target(self, now: float) -> int | None:
        return None if self._rate is None else int((now - self._start) * self._rate)

    def slice(self, target: int | None) -> bool:
        if self.tick >= self.breaks_at:
            raise RuntimeError("broken on purpose")
        time.sleep(self._cost)
        self.tick = self.tick + 512 if target is None else min(target, self.tick + 512)
        return target is None or self.tick < target

    def finish_round(self, target: int | None, now: float) -> None:
        self.rounds += 1

    def fail(self, error: Exception) -> None:
        self.failed, self.is_running = error, False


def until(holds: Callable[[], bool]) -> None:
    """Wait for something, however busy the machine is."""
    end = time.monotonic() + 60
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.fixture
def engine() -> Iterator[Engine]:
    found = Engine(Metrics(), lambda: None)
    found.start()
    yield found
    found.stop()


def test_paced_benches_keep_their_rate_beside_a_free_one(engine: Engine) -> None:
    works = [Work(str(n), 50_000.0, engine.clock) for n in range(4)] + [Work("free", None, engine.clock, 5e-4)]
    for work in works:
        engine.submit(engine.add, work).result(5)

    def keep_up() -> bool:  # whatever a busy machine takes from all of them, they make up
        due = [(engine.clock() - work._start) * 50_000 for work in works[:4]]
        return min(due) > 25_000 and all(
            work.tick == pytest.approx(ticks, rel=0.05) for work, ticks in zip(works[:4], due, strict=True)
        )

    until(keep_up)
    assert works[4].tick > 10 * 512


def test_a_job_is_done_between_two_slices_and_its_result_awaited(engine: Engine) -> None:
    work = Work("busy", None, engine.clock, 2e-3)
    engine.submit(engine.add, work).result(5)

    async def ask() -> tuple[int, float]:
        began = time.perf_counter()
        return await engine.call(lambda: work.tick), time.perf_counter() - began

    tick, waited = asyncio.run(ask())
    assert tick % 512 == 0
    assert waited < 30.0


def test_a_job_is_done_while_nothing_runs(engine: Engine) -> None:
    assert engine.submit(lambda: 42).result(2) == 42
    with pytest.raises(ZeroDivisionError):
        engine.submit(lambda: 1 / 0).result(2)
    assert engine.is_alive


def test_a_failure_stops_that_bench_alone(engine: Engine) -> None:
    good, bad = Work("good", 10_000.0, engine.clock), Work("bad", 10_000.0, engine.clock)
    bad.breaks_at = 1000
    engine.submit(engine.add, good).result(5)
    engine.submit(engine.add, bad).result(5)
    until(lambda: bad.failed is not None)
    assert isinstance(bad.failed, RuntimeError)
    before = good.tick
    until(lambda: good.tick > before)
    assert good.failed is None
    assert engine.is_alive


def test_after_the_end_nothing_is_taken() -> None:
    engine = Engine(Metrics(), lambda: None)
    engine.start()
    waiting = engine.submit(time.sleep, 0.1)
    engine.stop()
    assert waiting.done()
    assert not engine.is_alive
    with pytest.raises(RuntimeError, match="stopped"):
        engine.submit(lambda: 1)
