"""The times at which pages get pictures, and their shared pictures."""

from __future__ import annotations

import asyncio
import functools
import json
import selectors
from collections.abc import Callable
from typing import Any

import pytest

from scenarios.library import get
from scenarios.run import build
from server.bench.bench import LiveBench
from server.bench.commands import parse
from server.bench.status import Company, Somebody
from server.metrics import Metrics
from server.settings import Settings
from server.stream import client as client_module
from server.stream.client import Client
from server.stream.codec import Frame, decode
from server.stream.hub import EVENT_STATUS_S, PAGES_AT_ONCE, Hub
from server.stream.panel import Panel
from server.stream.wire import Reply, Subscribe


class Line:
    """A line that keeps the written bytes, and may be full."""

    def __init__(self) -> None:
        self.is_free = True
        self.written: list[bytes] = []
        self.waiting = self.passed_on = 0
        self.came = asyncio.Event()

    def write(self, data: bytes) -> None:
        self.written.append(data)
        self.came.set()

    def messages(self) -> list[Any]:
        """Read the written bytes, frame by frame of RFC 6455."""
        data, found = b"".join(self.written), []
        self.written = []
        while data:
            length, at = data[1], 2
            if length == 126:
                length, at = int.from_bytes(data[2:4]), 4
            elif length == 127:
                length, at = int.from_bytes(data[2:10]), 10
            body, text = data[at : at + length], data[0] == 0x81
            found.append(json.loads(body) if text else decode(body))
            data = data[at + length :]
        return found

    def frames(self) -> list[Frame]:
        return [message for message in self.messages() if isinstance(message, Frame)]


class Bench:
    """A bench with pages, all in this thread."""

    def __init__(self, **settings: Any) -> None:
        scenario = get("first-look")
        self.session = LiveBench(scenario, build(scenario), None, 20_000, Metrics(), lambda: 0.0)
        self.session.begin(True)
        self.hub = Hub(Settings(**settings), Metrics(), dict)

    def page(self, **fields: Any) -> tuple[Client, Any]:
        """Let a page watch, and say that all before is known to it."""
        line: Any = Line()
        room = self.hub.room(self.session)
        client = Client(line, self.session, Metrics().sent, room.news, room.cuts, self.session.events.last)
        told = {"signals": ["plant.displacement"], "window_ms": 1.0, "width": 100}
        wanted = Subscribe(type="subscribe", panel=1, **{**told, **fields})
        client.panels[1] = Panel(room.cuts.view(wanted, self.session.indices(wanted.signals), None), 1)
        self.hub.add(client)
        return client, line


class Time(selectors.SelectSelector):
    """The time of a loop: it passes at once where the loop would wait."""

    now = 100.0

    def select(self, timeout: float | None = None) -> Any:
        self.now += timeout or 0.0
        return super().select(0.0)


class QuickLoop(asyncio.SelectorEventLoop):
    """A loop that waits for nothing."""

    def __init__(self) -> None:
        self.passing = Time()
        super().__init__(self.passing)

    def time(self) -> float:
        return self.passing.now


def on_loop(test: Callable[..., Any]) -> Callable[..., None]:
    """Run a test on a loop of its own."""

    @functools.wraps(test)
    def run(**given: Any) -> None:
        with asyncio.Runner(loop_factory=QuickLoop) as runner:
            runner.run(test(**given))

    return run


async def turns(count: int = 5) -> None:
    """Let the loop turn some times."""
    for _ in range(count):
        await asyncio.sleep(0)


async def pass_time(loop: Any, seconds: float) -> None:
    """Let time pass on a loop, a tenth of a second at once."""
    for _ in range(round(10 * seconds)):
        loop.passing.now += 0.1
        await turns()


@on_loop
async def test_a_frame_comes_at_the_pace_of_frames_and_the_end_all_the_same() -> None:
    bench = Bench(frame_rate_hz=50.0)
    _, line = bench.page()
    bench.session.time.slice(100)
    bench.hub.publish()
    assert [frame.head for frame in line.frames()] == [100]
    bench.session.time.slice(120)
    bench.hub.publish()
    bench.session.time.slice(137)
    bench.session.execute(parse({"kind": "pause"}), "test")
    bench.hub.publish()
    assert not line.written  # its time has not come, and no later round of the engine will say so
    line.came.clear()
    await line.came.wait()
    said = line.messages()
    assert [m.head for m in said if isinstance(m, Frame)] == [bench.session.board.tick] == [137]
    assert [e["kind"] for m in said if isinstance(m, dict) and m["type"] == "events" for e in m["events"]] == ["pause"]
    bench.hub._show()
    assert not line.frames()  # once is enough


@on_loop
async def test_all_that_is_due_goes_out_in_one_write() -> None:
    bench = Bench()
    _, line = bench.page()
    bench.session.execute(parse({"kind": "time_scale", "value": 0.5}), "test")
    bench.session.time.slice(100)
    bench.hub.publish()
    assert len(line.written) == 1
    kinds = [message["type"] if isinstance(message, dict) else "frame" for message in line.messages()]
    assert kinds == ["events", "narration", "status", "frame"]


@on_loop
async def test_what_many_pages_see_is_made_once() -> None:
    bench = Bench()
    pages = [bench.page() for _ in range(3)]
    other, _ = bench.page(width=50)
    assert len({id(client.panels[1].view) for client, _ in pages}) == 1
    assert other.panels[1].view is not pages[0][0].panels[1].view
    bench.session.execute(parse({"kind": "time_scale", "value": 0.5}), "test")
    bench.session.time.slice(100)
    bench.hub.publish()
    assert len({bytes(line.written[0]) for _, line in pages}) == 1
    room = bench.hub.room(bench.session)
    news = room.news
    assert news.events(0) is news.events(0)
    assert news.status(0, 0) is news.status(0, 0)
    assert news.status(0, 3) != news.status(0, 0)


@on_loop
async def test_parameters_are_told_when_they_have_changed() -> None:
    bench = Bench()
    client, line = bench.page()

    def told() -> list[bool]:
        client.offer(status=True)
        return [m["parameters"] is not None for m in line.messages() if m["type"] == "status"]

    assert [told(), told()] == [[True], [False]]
    bench.session.execute(parse({"kind": "time_scale", "value": 0.5}), "test")
    assert told() == [False]  # an event, but nothing of the scenario
    bench.session.execute(parse({"set": {"reference.amplitude_v": 3.0}}), "test")
    assert [told(), told()] == [[True], [False]]


@on_loop
async def test_pages_of_a_paused_bench_are_told_who_comes_and_who_drives() -> None:
    bench = Bench()
    bench.session.execute(parse({"kind": "pause"}), "test")
    pages = [bench.page(), bench.page()]
    ada, ben = Somebody(id="a", name="Ada"), Somebody(id="b", name="Ben")

    def told() -> list[Any]:
        for client, _ in pages:
            client.offer(status=True)
        said = [[m for m in line.messages() if m["type"] == "status"][-1] for _, line in pages]
        assert said[0] == {**said[1], "parameters": said[0]["parameters"]}
        return [said[0]["watchers"], said[0]["company"] and said[0]["company"]["driver"]]

    assert told() == [2, None]
    around = {"is_leased": True, "drivers": [ada, ben], "asking": [], "lent_by": "", "more_watching": 0, "links": 0}
    for driver in (ada, ben, None):
        company = Company(**around, driver=driver, watching=["Cy"])
        bench.hub.company = lambda _bench_id, company=company: company  # type: ignore[misc]
        pages.append(bench.page())
        bench.hub.tell(bench.session.id)
        assert told() == [len(pages), driver and driver.model_dump()]


@on_loop
async def test_many_events_bring_the_status_now_and_then() -> None:
    bench = Bench()
    _, line = bench.page()
    room = bench.hub.room(bench.session)
    said: list[Any] = []
    for number in range(100):
        bench.session.execute(parse({"kind": "time_scale", "value": 0.5}), "test")
        list(room.publish(1e6 + 0.01 * number))
        said += [message for message in line.messages() if isinstance(message, dict)]
    seen = [event["seq"] for m in said if m["type"] == "events" for event in m["events"]]
    assert len(seen) == 100 and seen == list(range(seen[0], seen[0] + 100))
    statuses = sum(m["type"] == "status" for m in said)
    assert 100 * 0.01 / EVENT_STATUS_S <= statuses + 1 <= 100 * 0.01 / EVENT_STATUS_S + 2


@on_loop
async def test_a_full_line_is_left_alone_until_it_has_drained() -> None:
    bench = Bench()
    client, line = bench.page()
    line.is_free = False
    bench.session.time.slice(137)
    bench.session.execute(parse({"kind": "pause"}), "test")
    bench.hub.publish()
    assert not line.written
    line.is_free = True
    client.flush()
    assert [frame.head for frame in line.frames()] == [137]


@on_loop
async def test_a_page_that_stopped_for_a_minute_gets_the_newest_status_and_not_a_minute_of_them() -> None:
    bench = Bench()
    client, line = bench.page()

    def told(statuses: int) -> list[Any]:
        for _ in range(statuses):
            client.offer(status=True)
        return [message for message in line.messages() if message["type"] == "status"]

    assert len(told(300)) == 300  # a script that says nothing hears everything
    client.took(300)
    assert len(told(300)) == client_module.STATUSES
    bench.session.time.slice(120)
    bench.session.execute(parse({"kind": "pause"}), "test")
    client.answer(Reply(id="c1", ok=True, tick=120))
    assert [m["type"] for m in line.messages()] == ["status", "reply"]  # an answer does not wait
    client.cuts.refresh()
    client.offer(events=True, status=True, frame=True)
    assert not line.written
    client.took(10**9)  # its word for a status that was never sent is not taken
    said = line.messages()
    kinds = [m["type"] if isinstance(m, dict) else m.head for m in said]
    told_kinds = [kind for kind in kinds if kind != "narration"]
    assert told_kinds == ["events", "status", 120]
    assert next(m["state"] for m in said if isinstance(m, dict) and m["type"] == "status") == "paused"
    assert len(told(300)) == client_module.STATUSES - 1


@on_loop
async def test_words_are_not_taken_for_deeds() -> None:
    """A page that acknowledges everything, while nothing leaves for it, is closed like a silent page."""
    bench = Bench()
    client, line = bench.page()
    bench.session.time.slice(100)
    bench.hub.publish()
    line.waiting, now = 10_000, client._moved_at
    for step in range(60):
        client.acknowledge(10)
        assert client.stalled(now + 0.1 * step) == (0.1 * step > client_module.STALL_S)
    line.passed_on += 1
    assert not client.stalled(now + 6.1)


@on_loop
async def test_a_loop_that_was_blocked_blames_no_page() -> None:
    """Acknowledgements of that time wait to be read: a page is closed only if it is silent afterwards, too."""
    loop: Any = asyncio.get_running_loop()
    bench = Bench()
    bench.hub.clock = loop.time
    client, line = bench.page()
    client._clock, client._taken_at, client._moved_at = loop.time, loop.time(), loop.time()
    bench.session.time.slice(100)
    client.offer(frame=True)
    watching = asyncio.ensure_future(bench.hub.run())
    await turns()
    loop.passing.now += 2 * client_module.STALL_S  # blocked
    await turns()
    closings = [client.closing]
    client.acknowledge(1)
    line.passed_on += 1
    await pass_time(loop, 0.9 * client_module.STALL_S)
    closings.append(client.closing)
    line.waiting = 1
    await pass_time(loop, 1.1 * client_module.STALL_S)
    watching.cancel()
    assert closings == [None, None] and client.closing is not None


@pytest.mark.parametrize("hurt", ["_events", "_status", "_picture"])
@on_loop
async def test_one_broken_stream_does_not_harm_the_others(hurt: str, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench()
    bad, _ = bench.page()
    _, line = bench.page()
    monkeypatch.setattr(bad, hurt, lambda: 1 / 0)
    bench.session.execute(parse({"kind": "time_scale", "value": 0.5}), "test")
    bench.session.time.slice(100)
    bench.hub.publish()
    assert bad.closing is not None and bad.closing[0] == 1011
    assert len(line.frames()) == 1


@on_loop
async def test_many_pages_are_served_with_breaks_and_each_once() -> None:
    """The loop may do other things meanwhile; the next picture begins when all have this one."""
    bench = Bench()
    pages = [bench.page() for _ in range(3 * PAGES_AT_ONCE)]
    bench.session.time.slice(100)
    bench.hub.publish()
    assert sum(bool(line.written) for _, line in pages) == PAGES_AT_ONCE
    bench.session.time.slice(200)
    bench.hub.publish()
    await turns(1)
    assert sum(bool(line.written) for _, line in pages) == 2 * PAGES_AT_ONCE
    await turns()
    bench.hub._show()
    await turns()
    heads = {tuple(frame.head for frame in line.frames()) for _, line in pages}
    assert heads == {(100, 200)}


@on_loop
async def test_a_bench_that_cannot_be_shown_does_not_end_the_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench()
    _, line = bench.page()
    room = bench.hub.room(bench.session)
    with monkeypatch.context() as patched:
        patched.setattr(room.cuts, "refresh", lambda: 1 / 0)
        bench.session.time.slice(100)
        bench.hub.publish()
    assert not line.written
    bench.hub._show()
    assert [frame.head for frame in line.frames()] == [100]
