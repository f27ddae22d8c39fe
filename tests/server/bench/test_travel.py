"""A moment of the past that takes long to compute: the bench says how far it is, and gives it up for another."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from core.errors import InputError
from server.bench import travel as module
from server.bench.travel import Past, Travels
from tests.server.bench.test_session import advance, session


class Slow:
    """A moment of the past whose last half waits until the test releases it."""

    def __init__(self, tick: int) -> None:
        self.passage = SimpleNamespace(tick=tick)
        self.half, self.goes_on = threading.Event(), threading.Event()

    def journal(self, on_share: Callable[[float], None]) -> str:
        on_share(0.5)
        self.half.set()
        self.goes_on.wait()
        on_share(1.0)
        return f"made: {self.passage.tick}"

    def is_true(self) -> bool:
        return True


class Asked:
    """A bench that shows the past; it keeps each of its statuses."""

    def __init__(self) -> None:
        self.travel = None
        self.told: list[Any] = []
        self.half_is_told = threading.Event()

    def refresh_status(self) -> None:
        self.told.append(self.travel and self.travel.model_copy())
        if self.travel and self.travel.share == 0.5:
            self.half_is_told.set()


async def at_once(job: Callable[..., Any], *args: Any) -> Any:
    return job(*args)


@pytest.fixture
def travels(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setattr(module, "STATUS_S", 0.01)
    return Travels(SimpleNamespace(), SimpleNamespace(call=at_once), 1000)  # type: ignore[arg-type]


def test_a_bench_says_how_far_the_moment_is_that_is_asked_for(travels: Any) -> None:
    async def ask() -> str:
        computing = asyncio.create_task(travels._computed(past, bench, str))
        await asyncio.to_thread(past.half.wait)
        await asyncio.to_thread(bench.half_is_told.wait)
        past.goes_on.set()
        made: str = await computing
        return made

    past, bench = Slow(7), Asked()
    assert asyncio.run(ask()) == "made: 7"
    assert {one.tick for one in bench.told if one} == {7}
    assert bench.travel is None and bench.told[-1] is None


@pytest.mark.parametrize("last_is_first", [True, False])
def test_a_moment_is_given_up_when_another_is_sought(travels: Any, last_is_first: bool) -> None:
    async def ask() -> list[Any]:
        one, other, bench = Slow(1), Slow(2), Asked()
        wanted = one
        first = asyncio.create_task(travels._computed(one, bench, str, lambda: wanted is one))
        await asyncio.to_thread(one.half.wait)
        wanted = other
        second = asyncio.create_task(travels._computed(other, bench, str, lambda: wanted is other))
        await asyncio.to_thread(other.half.wait)
        for past, task in ((other, second), (one, first)) if last_is_first else ((one, first), (other, second)):
            past.goes_on.set()
            await asyncio.wait([task])
        assert bench.travel is None
        return await asyncio.gather(first, second, return_exceptions=True)

    first, second = asyncio.run(ask())
    assert second == "made: 2"
    assert isinstance(first, InputError) and first.code == "conflict" and first.field == "tick"


def test_two_who_fork_a_bench_both_have_their_moment(travels: Any) -> None:
    async def ask() -> list[str]:
        bench, pasts = Asked(), [Slow(1), Slow(2)]
        tasks = [asyncio.create_task(travels._computed(past, bench, str)) for past in pasts]
        for past in pasts:
            past.goes_on.set()
        return await asyncio.gather(*tasks)

    assert asyncio.run(ask()) == ["made: 1", "made: 2"]


def test_the_share_grows_to_the_whole_way() -> None:
    bench = session("first-look", samples=100_000)
    advance(bench, 9000)
    shares: list[float] = []

    past = Past.take(bench, 8000, 500)
    made = past.journal(shares.append)
    assert made.tick == 8000 and past.passage.checkpoint.tick == 0
    assert shares == sorted(shares) and 0.0 < shares[0] < shares[-1] == 1.0
