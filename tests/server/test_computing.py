"""Computations of requests: limits of time and memory, budgets, one request of a student at a time."""

from __future__ import annotations

import asyncio
import os
import threading
import time
from collections.abc import Awaitable, Callable, Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import pytest

from core.errors import InputError
from core.own.offered import PYTHON
from scenarios.campaign.executor import Processes
from scenarios.library import get
from server.clock import ManualClock
from server.computing.asker import asks
from server.computing.computing import BUDGET_S, EARNED, Computing
from server.errors import ApiError
from server.security.person import Person
from tests.core.own.texts import PI, odd
from tests.server.classroom.group import join, open_class
from tests.server.conftest import Live
from tests.server.forks import Forks

ADA, BOB = Person("ada", "Ada", "student"), Person("bob", "Bob", "student")
CHECK = "/api/v1/scenarios/check"
FOR_EVER: tuple[Any, ...] = (round, 7, -1_000_000_000)
"""A call that would keep the lock of the interpreter for hours."""


@pytest.fixture(scope="module")
def made() -> Iterator[tuple[Computing, ManualClock]]:
    """The place of one server, alone, and its clock."""
    clock = ManualClock()
    computing = Computing(clock)
    yield computing, clock
    computing.close()


def events(count: int) -> dict[str, Any]:
    """Return a scenario with so many events."""
    document = {key: value for key, value in get("first-look").document.items() if key != "expect"}
    return {**document, "events": [{"at_sample": i, "heal": "all"} for i in range(count)]}


async def as_person(person: Person | None, work: Callable[[], Awaitable[Any]]) -> Any:
    """Await work that a person asks for."""
    asks(person)
    return await work()


def test_a_call_that_takes_too_long_ends_alone_and_in_one_line(made: tuple[Computing, ManualClock]) -> None:
    computing, _ = made

    async def both() -> tuple[Any, Any]:
        endless = asyncio.create_task(computing.call(*FOR_EVER, most_s=0.2))
        other = await computing.call(os.getpid)
        with pytest.raises(InputError, match=r"^takes more than 0.2 s of processor time or 1024 MB of memory$"):
            await endless
        return other, [await computing.call(os.getpid) for _ in range(4)]

    before, after = asyncio.run(both())
    assert before in after and len({*after}) == 2, "the other process stays, and one takes the place of what ended"
    assert os.getpid() not in after


def test_a_process_that_ended_between_two_requests_is_replaced(
    made: tuple[Computing, ManualClock], monkeypatch: pytest.MonkeyPatch
) -> None:
    computing, _ = made
    submit, refused = Processes.submit, []

    def gone_once(worker: Processes, *arguments: Any) -> Any:
        if not refused:
            refused.append(worker)
            raise BrokenProcessPool("it has ended")
        return submit(worker, *arguments)

    monkeypatch.setattr(Processes, "submit", gone_once)
    assert asyncio.run(computing.call(os.getpid)) != os.getpid() and refused


@pytest.mark.parametrize("breaks", ["at once", "later"])
def test_a_machine_on_which_no_process_starts_is_at_fault_and_not_the_request(
    breaks: str, made: tuple[Computing, ManualClock], monkeypatch: pytest.MonkeyPatch
) -> None:
    def submit(_worker: Processes, *_arguments: Any) -> Any:
        if breaks == "at once":
            raise BrokenProcessPool("none starts")
        future: Future[Any] = Future()
        future.set_exception(BrokenProcessPool("none starts"))
        return future

    monkeypatch.setattr(Processes, "submit", submit)
    with pytest.raises(ApiError) as refused:
        asyncio.run(made[0].call(os.getpid))
    assert refused.value.status_code == 503 and "does not start" in refused.value.body.message


def test_a_call_that_takes_too_much_memory_is_refused(made: tuple[Computing, ManualClock]) -> None:
    computing, _ = made
    with pytest.raises(InputError, match="takes more than 1024 MB of memory"):
        asyncio.run(computing.call(bytes, 1 << 32))


def test_a_student_has_one_request_at_a_time_and_others_go_on(
    made: tuple[Computing, ManualClock], tmp_path: Path
) -> None:
    computing, _ = made
    os.mkfifo(pipe := tmp_path / "pipe")

    async def all_three() -> list[Any]:
        reading = asyncio.create_task(as_person(ADA, lambda: computing.call(Path.read_text, pipe)))
        waiting = asyncio.create_task(as_person(ADA, lambda: computing.call(os.getpid)))
        for _ in range(3):
            await asyncio.create_task(as_person(BOB, lambda: computing.call(os.getpid)))
        assert not reading.done() and not waiting.done()
        await asyncio.to_thread(pipe.write_text, "read")
        return [await reading, await waiting]

    read, pid = asyncio.run(all_three())
    assert read == "read" and pid != os.getpid()


def test_a_student_who_has_used_up_the_budget_waits_for_it(made: tuple[Computing, ManualClock]) -> None:
    computing, clock = made

    def ask(person: Person | None) -> Any:
        return asyncio.run(as_person(person, lambda: computing.call(os.getpid)))

    assert ask(ADA)
    computing._budgets.take(ADA.id, BUDGET_S)  # as much work as that
    with pytest.raises(ApiError, match=f"have taken more than {BUDGET_S:g} s of processor time") as refused:
        ask(ADA)
    assert refused.value.status_code == 429 and refused.value.headers == {"Retry-After": "4"}
    assert ask(BOB) and ask(None), "everybody has a budget of their own, and the teacher none"
    clock._now += 2.0 / EARNED
    assert ask(ADA)


def test_a_failure_is_told_as_one(made: tuple[Computing, ManualClock]) -> None:
    computing, _ = made
    with pytest.raises(RuntimeError, match="ZeroDivisionError"):
        asyncio.run(computing.call(divmod, 1, 0))


def test_a_scenario_of_a_student_has_so_many_events_at_every_door(live: Live) -> None:
    group = open_class(live)
    ada = join(live, group, "Ada")
    line = "events: a student's scenario may have at most 1000 events, and this one has 1001"
    reset = {"kind": "reset", "values": {"events": events(1001)["events"]}}
    for path, body in (
        (CHECK, {"scenario": events(1001)}),
        ("/api/v1/benches", {"scenario": events(1001)}),
        ("/api/v1/benches", {"scenario": "first-look", "set": reset["values"]}),
        (f"/api/v1/benches/{ada.bench}/commands", reset),
    ):
        error = ada.ask("POST", path, json=body).json()["error"]
        assert (error["code"], error["message"]) == ("too_much", line), path
    assert ada.ask("POST", CHECK, json={"scenario": events(1000)}).status_code == 200
    assert live.http.post(CHECK, json={"scenario": events(1001)}).status_code == 200
    live.http.delete(f"/api/v1/classes/{group['id']}")


def test_a_student_without_budget_makes_no_bench_and_resets_none(live: Live) -> None:
    group = open_class(live)
    ada, bob = join(live, group, "Ada"), join(live, group, "Bob")
    live.service.computing._budgets.take(ada.id, BUDGET_S)
    doors = {
        CHECK: {"scenario": events(1)},
        "/api/v1/benches": {"scenario": "first-look"},
        f"/api/v1/benches/{ada.bench}/commands": {"kind": "reset"},
        "/api/v1/devices/evaluate": {"device": {"id": "lcr-350"}},
        "/api/v1/theory/positive-definite": {"matrix": [[1.0]]},
        f"/api/v1/benches/{ada.bench}/identification": {},
    }
    for path, body in doors.items():
        answer = ada.ask("POST", path, json=body)
        assert (answer.status_code, answer.json()["error"]["code"]) == (429, "rate_limited"), path
        assert "s of processor time" in answer.json()["error"]["message"], path
        other = bob.ask("POST", path.replace(ada.bench, bob.bench), json=body)
        assert other.status_code in (200, 201), other.text
        bob.bench = bob.me()["bench"] or bob.bench
    assert ada.me()["bench"] == ada.bench
    live.http.delete(f"/api/v1/classes/{group['id']}")


def test_a_large_body_counts_as_many_requests(live: Live) -> None:
    group = open_class(live)
    ada, bob = join(live, group, "Ada"), join(live, group, "Bob")
    path, large = "/api/v1/theory/positive-definite", {"matrix": [[1.0]], "other": "x" * 1_000_000}
    answers = [ada.ask("POST", path, json=large).status_code for _ in range(25)]
    assert answers == [422] * answers.index(429) + [429] * (25 - answers.index(429)), answers
    assert bob.ask("POST", path, json=large).status_code == 422
    live.http.delete(f"/api/v1/classes/{group['id']}")


def test_a_check_says_what_it_said_and_compiles_nothing(live: Live) -> None:
    document = {**events(0), "units": {"pi": {"source": PI + "\n# checked, and never compiled\n"}}}
    found = live.http.post(CHECK, json={"scenario": document}).json()
    assert found["document"]["units"] == document["units"] and "[units.pi]" in found["toml"]
    refused = live.http.post(CHECK, json={"scenario": {**document, "units": {"pi": {"source": odd("step", "x = 1")}}}})
    assert refused.status_code == 422 and "line " in refused.json()["error"]["field"]


def delayed_s(pid: int) -> float:
    """Return how long the threads of a server and this thread have waited for a processor of the machine, s.

    That is not the server's doing: a thread that waits may hold the lock of the interpreter for which another waits.
    """
    waited = 0.0
    for file in [*Path(f"/proc/{pid}/task").glob("*/schedstat"), Path("/proc/thread-self/schedstat")]:
        with suppress(FileNotFoundError, ProcessLookupError):  # a thread that has ended
            waited += 1e-9 * float(file.read_text().split()[1])
    return waited


@contextmanager
def timed(ask: Callable[[], httpx.Response], pid: int) -> Iterator[list[float]]:
    """Ask again and again; note how long the server takes for each answer, s."""
    took: list[float] = []
    stop = threading.Event()

    def go_on() -> None:
        ask()  # now there is a connection
        while not stop.is_set():
            begun, before = time.perf_counter(), delayed_s(pid)
            assert ask().status_code in (200, 429)
            took.append(time.perf_counter() - begun - (delayed_s(pid) - before))

    thread = threading.Thread(target=go_on)
    thread.start()
    try:
        yield took
    finally:
        stop.set()
        thread.join()


def mean_s(count: int, ask: Callable[[], httpx.Response]) -> float:
    """Return how long an answer takes, the mean of several, s."""
    begun = time.perf_counter()
    for _ in range(count):
        assert ask().status_code == 200
    return (time.perf_counter() - begun) / count


HOSTILE = {
    "number": "7",
    "huge": "-1000000000",
    "text": repr("9" * 60_000),
    "numbers": "[1.0 for i in range(9999)]",
    "texts": f"[{'9' * 40!r} for i in range(9999)]",
    "lists": "[a for i in range(9999)]",
    "deep": "[d for i in range(9999)]",
}


def hostile_texts() -> Iterator[str]:
    """Yield units that give each function of Python each kind of argument, once and again and again."""
    helpers = (
        "def nested():\n    a = [1.0 for i in range(9999)]\n    b = [a for i in range(9999)]\n"
        "    c = [b for i in range(9999)]\n    return [c for i in range(9999)]"
    )
    for function, (_, most) in PYTHON.items():
        for first in HOSTILE.values():
            for rest in ((), *((other,) for other in HOSTILE.values() if most > 1)):
                call = f"{function.__name__}({', '.join(('f', *('g' for _ in rest)))})"
                lines = ["a = [1.0 for i in range(99)]", "d = nested()", f"f = {first}"]
                lines += [f"g = {other}" for other in rest]
                lines += ["for i in range(9999):", f"    h = {call}"]
                yield odd("pack", "\n".join(lines), top=helpers)
                yield odd("top", f"K = {function.__name__}({', '.join((first, *rest))})".replace("d for", "1 for"))


@pytest.mark.long
@pytest.mark.timeout(3000)
def test_no_hostile_unit_holds_the_health_check(loaded: Forks, tmp_path: Path) -> None:
    with (
        loaded.serve(tmp_path, figures=False, run_workers=0) as served,
        httpx.Client(base_url=served.address, trust_env=False, timeout=60) as anybody,
        timed(lambda: anybody.get("/health/live"), served.pid) as took,
    ):
        for text in hostile_texts():
            document = {**events(0), "units": {"odd": {"source": text}}}
            answer = served.http.post(CHECK, json={"scenario": document})
            assert answer.status_code in (200, 422), answer.text
    assert max(took) < 0.2


@pytest.mark.long
@pytest.mark.timeout(600)
def test_students_who_check_large_scenarios_cost_another_neither_time_nor_samples(
    loaded: Forks, tmp_path: Path
) -> None:
    with loaded.serve(tmp_path, figures=False, run_workers=0) as served, ExitStack() as others:
        group = open_class(served)
        *busy, ada = (join(served, group, name) for name in ("Bob", "Cleo", "Dan", "Ada"))
        ada.ask("POST", f"/api/v1/benches/{ada.bench}/commands", json={"kind": "start"})
        check = partial(ada.ask, "POST", CHECK, json={"scenario": events(1)})
        alone = mean_s(10, check)
        delayed = delayed_s(served.pid)
        before = ada.ask("GET", f"/api/v1/benches/{ada.bench}").json()["given_up_ms"]
        for student in busy:
            large = partial(student.ask, "POST", CHECK, json={"scenario": events(1000)})
            others.enter_context(timed(large, served.pid))
        assert mean_s(10, check) - alone < 1.0
        given_up_ms = ada.ask("GET", f"/api/v1/benches/{ada.bench}").json()["given_up_ms"] - before
        assert given_up_ms <= 1e3 * (delayed_s(served.pid) - delayed), "more than the machine took"
