"""The watchdog: a hang and a broken thread are seen in time, load and long work never trip."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from server.bench.bench import LiveBench
from server.bench.engine import Engine
from server.bench.watchdog import LATE_COUNTS_S, LOOK_S, SILENT_S, STUCK_S, Activity, Watchdog, _is_ready
from server.metrics import Metrics
from tests.server.bench.test_engine import Work, until


class Clock:
    """A clock that a test turns."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class FakeEngine:
    """An engine that gives its signs of life as a test says."""

    def __init__(self) -> None:
        self.clock, self.expected, self.has_ended = Clock(), 100.0, False
        self.running: list[Any] = [Work("a", 1.0, lambda: 0.0)]
        self.threads: list[Any] = []
        self.held: list[Any] = []


class Heard:
    """The messages of the watchdog."""

    def __init__(self) -> None:
        self.hangs: list[tuple[list[str], list[str], str]] = []
        self.stuck_benches: list[list[str]] = []
        self.recoveries = 0

    def hung(self, running: Sequence[LiveBench], held: Sequence[str], why: str) -> None:
        self.hangs.append(([work.id for work in running], list(held), why))

    def stuck(self, held: Sequence[str]) -> None:
        self.stuck_benches.append(list(held))

    def recovered(self) -> None:
        self.recoveries += 1


class Told(Activity):
    """Returns the work that a test sets."""

    worked_s = 0.0

    def measure(self, threads: Any) -> float:
        return self.worked_s


class Yard:
    """A watchdog, and its surroundings."""

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


def test_an_engine_that_comes_back_may_hang_again(yard: Yard) -> None:
    yard.look(0.5)
    yard.look(0.5, sign=lambda: True)
    assert not yard.dog.barks
    yard.look(0.5)
    assert len(yard.heard.hangs) == 2 and not yard.dog.is_stuck


def test_looks_that_are_late_count_little(yard: Yard) -> None:
    """A machine that stalls now and then, or was suspended, delays the engine and the watchdog alike."""
    late = round(SILENT_S / LATE_COUNTS_S)
    yard.look(60.0 * (late - 1), every=60.0)
    assert yard.heard.hangs == []
    yard.look(120.0, every=60.0)
    assert len(yard.heard.hangs) == 1 and not yard.dog.is_stuck


@pytest.mark.parametrize("worked_s", [1e-6, LOOK_S, math.inf])
def test_work_is_no_silence(yard: Yard, worked_s: float) -> None:
    yard.told.worked_s = worked_s
    yard.look(0.9 * STUCK_S)
    assert yard.heard.hangs == []


def test_blocks_do_not_add_up_to_a_silence(yard: Yard) -> None:
    for _ in range(200):
        yard.told.worked_s = 0.0
        yard.look(0.7 * SILENT_S)
        yard.told.worked_s = 1e-6
        yard.look(LOOK_S)
    assert yard.heard.hangs == []


def test_work_without_end_makes_the_engine_stuck_but_a_compilation_does_not(yard: Yard) -> None:
    yard.told.worked_s = math.inf
    yard.look(3 * STUCK_S)
    assert yard.heard.hangs == [] and not yard.dog.is_stuck
    yard.told.worked_s = LOOK_S
    yard.look(STUCK_S + 1.0)
    assert len(yard.heard.hangs) == 1 and yard.dog.is_stuck


def test_nothing_is_due_while_nothing_runs(yard: Yard) -> None:
    yard.engine.expected = yard.engine.clock.now + 1e6
    yard.look(2 * STUCK_S)
    assert yard.heard.hangs == [] and not yard.dog.is_stuck


def test_a_job_that_hangs_while_nothing_runs_trips_nothing_and_makes_the_engine_stuck(yard: Yard) -> None:
    yard.engine.running = []
    yard.look(STUCK_S + 0.1)
    assert yard.heard.hangs == [] and yard.dog.is_stuck and yard.heard.stuck_benches == [[]]


def test_a_bench_that_hangs_is_named_and_recorded_once(yard: Yard) -> None:
    yard.engine.held = [yard.engine.running[0]]
    yard.look(1.0)
    assert yard.heard.hangs[0][1] == ["a"] and yard.heard.stuck_benches == []
    yard.look(2 * STUCK_S)
    assert yard.heard.stuck_benches == [["a"]] and yard.dog.is_stuck and len(yard.heard.hangs) == 1


def test_an_engine_that_moves_again_is_stuck_no_longer(yard: Yard) -> None:
    yard.look(STUCK_S + 1.0)
    assert yard.dog.is_stuck
    yard.look(LOOK_S, sign=lambda: True)
    assert not yard.dog.is_stuck and not yard.dog.barks and yard.heard.recoveries == 1


def test_a_thread_that_has_ended_is_told_at_once(yard: Yard) -> None:
    yard.engine.has_ended = True
    yard.look(LOOK_S)
    assert yard.heard.hangs == [(["a"], [], "the engine broke off")] and yard.dog.is_stuck


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


def test_a_blocked_thread_has_no_activity_and_a_thread_that_computes_has() -> None:
    over, activity = threading.Event(), Activity()

    def spin() -> None:
        while not over.is_set():
            pass

    waits, spins = (threading.Thread(target=work, daemon=True) for work in (over.wait, spin))
    for thread in (waits, spins):
        thread.start()
    until(lambda: activity.measure([spins]) > 0.0)
    measured: list[float] = []

    def is_blocked() -> bool:
        measured.append(activity.measure([waits]))
        return measured[-3:] == [0.0, 0.0, 0.0]

    until(is_blocked)
    over.set()
    for thread in (waits, spins):
        thread.join(30)


def test_a_thread_inside_an_import_waits_for_others() -> None:
    inside, over = threading.Event(), threading.Event()
    frames: dict[str, Any] = {"__name__": "llvmlite.binding", "inside": inside, "over": over}
    exec("def compile_it():\n    inside.set()\n    over.wait()\n", frames)
    thread = threading.Thread(target=frames["compile_it"], daemon=True)
    thread.start()
    assert inside.wait(30)
    assert Activity().measure([thread]) == math.inf
    over.set()
    thread.join(30)


def test_a_thread_that_wants_a_processor_is_told_from_one_that_waits() -> None:
    if not Path("/proc/self/task").exists():
        pytest.skip("this system does not tell the state of a thread")
    over = threading.Event()

    def spin() -> None:
        while not over.is_set():
            pass

    spins, waits = (threading.Thread(target=work, daemon=True) for work in (spin, over.wait))
    for thread in (spins, waits):
        thread.start()
    until(lambda: _is_ready(spins) and not _is_ready(waits))
    over.set()
    for thread in (spins, waits):
        thread.join(30)
