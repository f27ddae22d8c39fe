"""The watchdog: a hang and a death are seen in time, load and long work never trip."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from server.bench.engine import Engine, Workload
from server.bench.pulse import Finger, Pulse
from server.bench.watchdog import GIVEN_UP_S, LONG_S, LOOK_S, MOST_S, SILENT_S, Watchdog
from server.metrics import Metrics
from tests.server.bench.test_engine import Work, until

BLOCKED, STARVED = Pulse(True, 0.0), Pulse(False, 0.0)
WORKING = Pulse(False, LOOK_S)


class Clock:
    """A clock that a test turns."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class Main:
    """A thread whose life is set by a test."""

    alive = True

    def is_alive(self) -> bool:
        return self.alive


class FakeCrew:
    """Threads that obey the test."""

    def __init__(self) -> None:
        self.main, self.threads, self.held, self.in_hand = Main(), [], [], {}


class FakeEngine:
    """An engine that gives its signs of life as a test says."""

    def __init__(self) -> None:
        self.clock, self.crew, self.expected = Clock(), FakeCrew(), 100.0
        self.running: list[Any] = [Work("a", 1.0, lambda: 0.0)]
        self.taken_over = 0

    def take_over(self, lost: Callable[[list[Any]], None]) -> None:
        self.taken_over += 1
        lost(self.crew.held)
        self.crew, self.expected = FakeCrew(), self.clock.now


class Heard:
    """The messages of the watchdog."""

    def __init__(self) -> None:
        self.hangs: list[tuple[list[str], list[str], str]] = []
        self.lost: list[str] = []

    def hung(self, running: Sequence[Workload], held: Sequence[str], why: str) -> None:
        self.hangs.append(([work.id for work in running], list(held), why))

    def given_up(self, benches: Sequence[Workload]) -> None:
        self.lost += [work.id for work in benches]


class Told(Finger):
    """Returns the pulse that a test sets."""

    pulse = BLOCKED

    def feel(self, threads: Any, passed_s: float) -> Pulse:
        return self.pulse


class Yard:
    """A watchdog, and all it looks at."""

    def __init__(self) -> None:
        self.engine, self.heard, self.told = FakeEngine(), Heard(), Told()
        self.dog = Watchdog(self.engine, self.heard, self.told)  # type: ignore[arg-type]

    def look(self, seconds: float, every: float = LOOK_S, sign: Callable[[], bool] = lambda: False) -> None:
        end = self.engine.clock.now + seconds
        while self.engine.clock.now < end - 1e-9:
            self.engine.clock.now += every
            if sign():
                self.engine.expected = self.engine.clock.now
            self.dog.look()


@pytest.fixture
def yard() -> Yard:
    return Yard()


def test_a_hang_is_seen_within_150_ms_and_told_once(yard: Yard) -> None:
    yard.look(1.0, sign=lambda: True)
    began = yard.engine.clock.now
    while not yard.heard.hangs:
        yard.look(LOOK_S)
    assert SILENT_S <= yard.engine.clock.now - began < 0.15
    yard.look(1.0)
    assert [running for running, _, _ in yard.heard.hangs] == [["a"]] and yard.dog.barks
    assert yard.heard.hangs[0][2].startswith("the engine gave no sign for 1")


def test_whoever_comes_back_may_hang_again(yard: Yard) -> None:
    yard.look(0.5)
    yard.look(0.5, sign=lambda: True)
    assert not yard.dog.barks
    yard.look(0.5)
    assert len(yard.heard.hangs) == 2 and yard.engine.taken_over == 0


def test_looks_that_are_late_count_little(yard: Yard) -> None:
    """A machine that stalls now and then delays the engine and the watchdog alike."""
    late = SILENT_S / MOST_S
    yard.look(10.0 * (late - 1), every=10.0)
    assert yard.heard.hangs == []
    yard.look(20.0, every=10.0)
    assert len(yard.heard.hangs) == 1 and yard.engine.taken_over == 0


@pytest.mark.parametrize("pulse", [STARVED, WORKING])
def test_neither_a_wait_for_a_processor_nor_long_work_is_silence(yard: Yard, pulse: Pulse) -> None:
    yard.told.pulse = pulse
    yard.look(0.9 * LONG_S)
    assert yard.heard.hangs == []


def test_a_wait_beside_threads_that_want_a_processor_is_silence_only_when_it_lasts(yard: Yard) -> None:
    """One of them may hold the lock that the engine waits for."""
    yard.told.pulse = Pulse(True, 0.0, is_crowded=True)
    yard.look(9 * SILENT_S)
    assert yard.heard.hangs == []
    yard.look(2 * SILENT_S)
    assert len(yard.heard.hangs) == 1


def test_blocks_that_add_up_are_no_silence(yard: Yard) -> None:
    for _ in range(200):
        yard.told.pulse = BLOCKED
        yard.look(0.7 * SILENT_S)
        yard.told.pulse = STARVED
        yard.look(LOOK_S)
    assert yard.heard.hangs == []


def test_work_without_end_is_a_hang(yard: Yard) -> None:
    yard.told.pulse = WORKING
    yard.look(1.1 * LONG_S)
    assert len(yard.heard.hangs) == 1 and yard.engine.taken_over == 0
    yard.look(LONG_S)
    assert yard.engine.taken_over == 1


def test_nothing_is_due_while_nothing_runs(yard: Yard) -> None:
    yard.engine.expected = yard.engine.clock.now + 1e6
    yard.look(20.0)
    assert yard.heard.hangs == [] and yard.engine.taken_over == 0


def test_a_job_that_hangs_while_nothing_runs_trips_nothing_and_is_given_up(yard: Yard) -> None:
    yard.engine.running = []
    yard.look(GIVEN_UP_S + 0.1)
    assert yard.heard.hangs == [] and yard.engine.taken_over == 1


def test_a_bench_that_hangs_is_named_and_given_up_in_the_end(yard: Yard) -> None:
    stuck = yard.engine.running[0]
    yard.engine.crew.held = [stuck]
    yard.look(1.0)
    assert yard.heard.hangs[0][1] == ["a"] and yard.heard.lost == []
    yard.look(GIVEN_UP_S - 0.95)
    assert yard.heard.lost == ["a"] and yard.engine.taken_over == 1 and not yard.dog.barks


def test_a_thread_that_has_ended_is_replaced_at_once(yard: Yard) -> None:
    yard.engine.crew.main.alive = False
    yard.look(LOOK_S)
    assert yard.heard.hangs == [(["a"], [], "the engine broke off")] and yard.engine.taken_over == 1


def test_what_a_helper_has_in_hand_is_waited_for_when_the_thread_has_ended(yard: Yard) -> None:
    yard.engine.crew.main.alive, yard.engine.crew.held = False, [yard.engine.running[0]]
    yard.look(0.5)
    assert len(yard.heard.hangs) == 1 and yard.engine.taken_over == 0
    yard.engine.crew.held = []
    yard.look(LOOK_S)
    assert yard.engine.taken_over == 1 and yard.heard.lost == []


class Slow(Work):
    """A bench whose slices last."""

    def slice(self, target: int | None) -> bool:
        time.sleep(0.02)
        return super().slice(target)


def test_an_engine_that_cannot_keep_up_never_trips() -> None:
    engine, heard = Engine(Metrics(), lambda: None), Heard()
    dog = Watchdog(engine, heard)
    engine.start()
    dog.start()
    works = [Slow(str(n), 1e7, engine.clock) for n in range(4)]
    for work in works:
        engine.submit(engine.add, work).result(5)
    until(lambda: min(work.rounds for work in works) > 20)
    dog.stop()
    engine.stop()
    assert heard.hangs == []
    assert all(work.tick < work.target(engine.clock()) for work in works), "they do not keep up"
