"""Urgent functions come first, and a helper that breaks off ends the thread that waits for it."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest

from server.bench.engine import PROCESSORS, Engine
from server.metrics import Metrics
from tests.server.bench.test_engine import Work, until


class Stuck(Work):
    """A bench that waits in a slice until it is released."""

    def __init__(self, engine: Engine, name: str = "stuck") -> None:
        super().__init__(name, 1e4, engine.clock)
        self.let_go, self.hangs = threading.Event(), threading.Event()

    def slice(self, target: int | None) -> bool:
        self.hangs.set()
        self.let_go.wait()
        return False


@pytest.fixture
def engine() -> Iterator[Engine]:
    found = Engine(Metrics(), lambda: None)
    found.start()
    yield found
    found.stop()


def test_a_helper_that_breaks_off_ends_the_thread_that_waits_for_it(engine: Engine) -> None:
    deadly, helps = threading.Event(), threading.Event()

    class Dies(Work):
        def slice(self, target: int | None) -> bool:
            if deadly.is_set() and threading.current_thread() is not engine.threads[0]:
                helps.set()
                raise SystemExit
            if deadly.is_set():  # so that the other is left to a helper
                helps.wait(30)
            return super().slice(target)

    for number in range(2):
        engine.submit(engine.add, Dies(str(number), 1e6, engine.clock)).result(30)
    deadly.set()
    until(lambda: engine.has_ended)
    assert engine.held == []


def test_an_urgent_function_comes_before_every_other_slice_and_job(engine: Engine) -> None:
    order: list[str] = []
    let_go, begun = threading.Event(), threading.Event()

    class Noted(Work):
        def slice(self, target: int | None) -> bool:
            order.append("slice")
            return super().slice(target)

    def hang() -> None:
        begun.set()
        let_go.wait()
        order.append("hung")

    engine.submit(engine.add, Noted("noted", None, engine.clock)).result(30)
    engine.submit(hang)
    assert begun.wait(30)
    order.clear()
    jobs = [engine.submit(order.append, "job")]
    engine.interrupt(lambda: order.append("urgent"))
    let_go.set()
    jobs[0].result(30)
    until(lambda: "slice" in order)
    assert order[:3] == ["hung", "urgent", "job"]


def test_no_slice_begins_while_an_urgent_function_waits(engine: Engine) -> None:
    stuck = [Stuck(engine, str(number)) for number in range(PROCESSORS)]
    last = Work("last", 1e9, engine.clock)
    found: list[int] = []

    def add_all() -> None:  # all in one round, and every thread hangs before the last has its turn
        for work in (*stuck, last):
            engine.add(work)

    engine.submit(add_all).result(30)
    assert all(work.hangs.wait(30) for work in stuck)
    engine.interrupt(lambda: found.append(last.tick))
    for work in stuck:
        work.let_go.set()
    until(lambda: last.tick > 0)
    assert found == [0]


def test_the_end_does_not_wait_for_a_bench_that_hangs() -> None:
    engine = Engine(Metrics(), lambda: None)
    engine.start()
    stuck = Stuck(engine)
    engine.submit(engine.add, stuck).result(30)
    assert stuck.hangs.wait(30)
    assert engine.held == [stuck] and all(thread.daemon for thread in engine.threads)
    stuck.let_go.set()
    engine.stop()
    assert not engine.is_alive


def test_a_thread_that_breaks_off_answers_its_job(engine: Engine) -> None:
    def die() -> None:
        raise SystemExit

    with pytest.raises(SystemExit):
        engine.submit(die).result(30)
    until(lambda: engine.has_ended)
    assert not engine.is_alive
