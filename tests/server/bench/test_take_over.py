"""Other threads take the place of hanging threads: jobs continue, and a thread that comes back changes nothing."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest

from server.bench.engine import PROCESSORS, Engine, Workload
from server.errors import ApiError
from server.metrics import Metrics
from tests.server.bench.test_engine import Work, until


class Stuck(Work):
    """A bench that waits in a slice until it is released."""

    def __init__(self, engine: Engine, name: str = "stuck") -> None:
        super().__init__(name, 1e4, engine.clock)
        self.let_go, self.hangs, self.went_on = threading.Event(), threading.Event(), False

    def slice(self, target: int | None) -> bool:
        self.hangs.set()
        self.let_go.wait()
        self.went_on = True
        return False


def ended(crew: Any) -> None:
    """Wait for the end of all threads of a crew."""
    for thread in list(crew.threads):
        thread.join(30)
    assert crew.threads == []


@pytest.fixture
def engine() -> Iterator[Engine]:
    found = Engine(Metrics(), lambda: None)
    found.start()
    yield found
    found.stop()


def test_a_bench_that_hangs_is_given_up_and_the_others_go_on(engine: Engine) -> None:
    good, stuck = Work("good", 1e4, engine.clock), Stuck(engine)
    for work in (good, stuck):
        engine.submit(engine.add, work).result(5)
    assert stuck.hangs.wait(30)
    before = engine.crew
    until(lambda: before.held == [stuck])
    lost: list[Workload] = []
    engine.take_over(lost.extend)
    assert lost == [stuck]
    ticks = good.tick
    until(lambda: good.tick > ticks)
    assert engine.running == [good] and engine.is_alive
    stuck.let_go.set()
    ended(before)
    assert not stuck.went_on, "who is left behind runs no further line"


def test_a_job_that_hangs_is_answered_and_the_next_is_done(engine: Engine) -> None:
    let_go, begun = threading.Event(), threading.Event()
    after: list[str] = []

    def hang() -> None:
        begun.set()
        let_go.wait()
        after.append("went on")

    hung, waiting = engine.submit(hang), engine.submit(lambda: 42)
    assert begun.wait(30)
    before = engine.crew
    lost: list[Workload] = []
    engine.take_over(lost.extend)
    assert lost == []
    assert waiting.result(30) == 42
    with pytest.raises(ApiError, match="given it up"):
        hung.result(30)
    let_go.set()
    ended(before)
    assert after == []


def test_a_thread_that_dies_answers_its_job_and_another_takes_its_place(engine: Engine) -> None:
    def die() -> None:
        raise SystemExit

    with pytest.raises(SystemExit):
        engine.submit(die).result(30)
    before = engine.crew
    before.main.join(30)
    assert not engine.is_alive and before.held == []
    waiting = engine.submit(lambda: 42)
    lost: list[Workload] = []
    engine.take_over(lost.extend)
    assert lost == []
    assert waiting.result(30) == 42
    ended(before)


def test_what_ends_a_helper_ends_the_thread_that_waits_for_it(engine: Engine) -> None:
    deadly, helps = threading.Event(), threading.Event()

    class Dies(Work):
        def slice(self, target: int | None) -> bool:
            if deadly.is_set() and threading.current_thread() is not engine.crew.main:
                helps.set()
                raise SystemExit
            if deadly.is_set():  # so that the other is left to a helper
                helps.wait(30)
            return super().slice(target)

    for number in range(2):
        engine.submit(engine.add, Dies(str(number), 1e6, engine.clock)).result(30)
    deadly.set()
    engine.crew.main.join(30)
    assert not engine.crew.main.is_alive() and engine.crew.held == []


def test_what_is_urgent_comes_before_every_other_slice_and_job(engine: Engine) -> None:
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


def test_while_something_urgent_waits_no_slice_begins(engine: Engine) -> None:
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


def test_the_end_does_not_wait_for_what_hangs() -> None:
    engine = Engine(Metrics(), lambda: None)
    engine.start()
    stuck = Stuck(engine)
    engine.submit(engine.add, stuck).result(30)
    assert stuck.hangs.wait(30)
    assert all(thread.daemon for thread in engine.crew.threads)
    engine.take_over(lambda lost: None)
    engine.stop()
    assert not engine.is_alive
    stuck.let_go.set()
