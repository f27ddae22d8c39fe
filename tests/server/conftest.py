"""A real server on loopback, spoken to by HTTP and WebSocket."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
from collections import deque
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from scenarios.campaign.executor import Processes
from server.app import create_app
from server.cli.serve import bind, make_server
from server.computing.computing import Computing
from server.settings import Settings
from server.stream.codec import Frame, decode
from server.stream.wire import SUBPROTOCOL
from tests.server.forks import Forks, forks, start_none

TOKEN = "a-token-for-the-tests-only"
HANGS_S = 60.0
"""A server that says nothing for so long hangs."""
_computers: list[Processes] = []
LOOK_S = 0.05
"""Time that passes between two looks at a bench, by the clock that tests advance."""


class Stream:
    """One WebSocket to a bench, with what came over it sorted by type."""

    def __init__(self, connection: ClientConnection, live: Live | None = None) -> None:
        self.connection, self._live = connection, live
        self.frames: list[Frame] = []
        self.messages: list[dict[str, Any]] = []
        self.acks = True

    def send(self, **message: Any) -> None:
        self.connection.send(json.dumps(message))

    @property
    def events(self) -> list[dict[str, Any]]:
        """Every event that has come, in the order it came."""
        return [event for m in self.messages if m["type"] == "events" for event in m["events"]]

    def until_event(self, timeout: float = HANGS_S, **fields: Any) -> dict[str, Any]:
        """Return the first event with these fields: an event that has come already, or the next one."""

        def found() -> list[dict[str, Any]]:
            return [event for event in self.events if fields.items() <= event.items()]

        if not found():
            self.until(lambda _: bool(found()), timeout)
        return found()[0]

    def step(self, timeout: float = HANGS_S) -> dict[str, Any] | Frame:
        """Take one message; acknowledge frames unless disabled."""
        data = self.connection.recv(timeout=timeout)
        if isinstance(data, bytes):
            frame = decode(data)
            self.frames.append(frame)
            if self.acks:
                self.send(type="ack", frame=frame.frame)
            return frame
        message: dict[str, Any] = json.loads(data)
        self.messages.append(message)
        return message

    def until(self, what: Callable[[Any], bool], timeout: float = HANGS_S) -> Any:
        """Take messages until one is as asked."""
        while not what(message := self.step(timeout)):
            pass
        return message

    def until_type(self, kind: str, timeout: float = HANGS_S, **fields: Any) -> dict[str, Any]:
        wanted = {"type": kind, **fields}
        found: dict[str, Any] = self.until(
            lambda m: isinstance(m, dict) and all(m.get(name) == value for name, value in wanted.items()), timeout
        )
        return found

    def until_frame(self, panel: int | None = None, timeout: float = HANGS_S) -> Frame:
        found: Frame = self.until(
            lambda m: isinstance(m, Frame) and (panel is None or any(p.panel == panel for p in m.panels)), timeout
        )
        return found

    def until_closed(self) -> Any:
        """Take messages until the server closes; return its code and reason."""
        with pytest.raises(ConnectionClosed) as caught:
            self.until(lambda _: False)
        return caught.value.rcvd

    def advance_until(self, what: Callable[[Any], bool]) -> Any:
        """Let time pass until a message that comes is as asked."""
        assert self._live is not None
        frames, messages = len(self.frames), len(self.messages)
        while True:
            self.settle()
            found = [one for one in (*self.frames[frames:], *self.messages[messages:]) if what(one)]
            if found:
                return found[0]
            self._live.advance(seconds=LOOK_S)

    def settle(self) -> None:
        """Take all that the server has to show and say; after that nothing is on its way."""
        assert self._live is not None
        frames = -1
        while frames < len(self.frames):  # an acknowledgement may bring another picture
            frames = len(self.frames)
            self._live.show()
            assert self.connection.ping().wait(HANGS_S)
            with contextlib.suppress(TimeoutError):
                while True:
                    self.step(0.0)

    def command(self, kind: str = "", **fields: Any) -> dict[str, Any]:
        """Give a command that runs the bench, by its kind, or one to the board."""
        self.send(type="command", id=f"c{len(self.messages)}", command={**({"kind": kind} if kind else {}), **fields})
        return self.until_type("reply")


class Live:
    """A server under test."""

    def __init__(self, app: Any, server: Any, address: str) -> None:
        self.app, self.server, self.address = app, server, address
        self.service = app.state.service
        self.http = httpx.Client(
            base_url=address, headers={"Authorization": f"Bearer {TOKEN}"}, timeout=120, trust_env=False, verify=False
        )

    def anonymous(self, **options: Any) -> httpx.Client:
        # it verifies nothing over plain HTTP, and need not read all certificates of the machine for that
        return httpx.Client(base_url=self.address, timeout=120, trust_env=False, verify=False, **options)

    def bench(self, scenario: Any = "ch5-seven-step", **fields: Any) -> dict[str, Any]:
        answer = self.http.post("/api/v1/benches", json={"scenario": scenario, **fields})
        assert answer.status_code == 201, answer.text
        found: dict[str, Any] = answer.json()
        return found

    def get(self, bench_id: str) -> dict[str, Any]:
        found: dict[str, Any] = self.http.get(f"/api/v1/benches/{bench_id}").json()
        return found

    def until(self, bench_id: str, what: Callable[[dict[str, Any]], bool]) -> None:
        """Look at a bench until something holds of it, and let time pass between two looks."""
        if self.service.clock.is_manual:
            while not what(self.get(bench_id)):
                self.advance(seconds=LOOK_S)
            return
        with self.stream(bench_id) as stream:
            while not what(self.get(bench_id)):
                stream.until_type("status")

    def advance(self, seconds: float | None = None, bench: str = "", ticks: int | None = None) -> dict[str, int]:
        """Let seconds pass, or so many ticks of a bench; return the tick of every bench."""
        asked = {"seconds": seconds} if seconds is not None else {"bench": bench, "ticks": ticks}
        answer = self.http.post("/api/v1/testing/advance", json=asked)
        assert answer.status_code == 200, answer.text
        found: dict[str, int] = answer.json()["ticks"]
        return found

    def show(self) -> None:
        """Make the server carry out its requests, and show them on all streams, without a wait for the frame rate."""

        async def shown() -> None:
            await self.service.engine.call(lambda: None)
            self.service.hub._show()

        self.on_loop(shown())

    def wait(self, what: Callable[[], Any]) -> Any:
        """Ask the server for its health until something holds that no message tells; return it."""
        while not (found := what()):
            self.http.get("/health/live")
        return found

    def on_loop(self, work: Coroutine[Any, Any, Any]) -> Any:
        """Do something on the event loop of the server."""
        return asyncio.run_coroutine_threadsafe(work, self.service._loop).result(HANGS_S)

    def ended(self, row_id: str, seconds: float = 240.0) -> None:
        """Wait until a run, a campaign or a search is no longer under way."""
        tasks = self.service.queue._tasks

        async def over() -> None:
            if row_id in tasks:
                await asyncio.wait([tasks[row_id]])

        asyncio.run_coroutine_threadsafe(over(), self.service._loop).result(seconds)

    def command(self, bench_id: str, kind: str = "", **fields: Any) -> httpx.Response:
        """Give a command that runs the bench, by its kind, or one to the board."""
        command = {**({"kind": kind} if kind else {}), **fields}
        return self.http.post(f"/api/v1/benches/{bench_id}/commands", json=command)

    @contextmanager
    def stream(self, bench_id: str, **options: Any) -> Iterator[Stream]:
        given: dict[str, Any] = {
            "additional_headers": {"Authorization": f"Bearer {TOKEN}"},
            "subprotocols": [SUBPROTOCOL],
            "proxy": None,
            "max_size": None,
            "max_queue": None,
            "compression": None,
        }
        url = self.address.replace("http", "ws") + f"/api/v1/benches/{bench_id}/stream"
        with connect(url, **{**given, **options}) as connection:
            yield Stream(connection, self)


@contextmanager
def serving(folder: Path, **fields: Any) -> Iterator[Live]:
    """Serve from a thread, on a free port, until the test is over.

    Time passes by `Live.advance` alone, except where ``clock="machine"`` asks for the clock of the machine, or where
    other machines could reach the server. Processes for runs are started with the first run.
    """
    generous = {"command_rate_per_s": 10_000.0, "command_burst": 10_000, "max_benches": 64}
    clock = "machine" if fields.keys() & {"host", "public_origin", "classroom"} else "manual"
    usual = {"port": 0, "data": folder, "token": TOKEN, "figures": False, "clock": clock}
    settings = Settings(**{**usual, **generous, **fields})
    app = create_app(settings)
    listener = bind(settings)
    server, started = make_server(settings, app), threading.Event()
    app.state.service.queue.warm = start_none
    _share_processes(app.state.service.computing)
    start = server.startup

    async def startup(*arguments: Any, **named: Any) -> None:
        await start(*arguments, **named)
        started.set()

    def run() -> None:
        try:
            server.run(sockets=[listener])
        finally:
            started.set()

    server.startup = startup  # type: ignore[method-assign]
    thread = threading.Thread(target=run)
    thread.start()
    started.wait()
    assert server.started, "the server did not start"
    live = Live(app, server, f"http://127.0.0.1:{listener.getsockname()[1]}")
    try:
        yield live
    finally:
        live.http.close()
        server.should_exit = True
        thread.join(90)
        assert not thread.is_alive(), "the server did not stop"


def _share_processes(computing: Computing) -> None:
    """Let all servers of this process compute in the same processes: each takes a second to start."""
    _computers.extend(computing._all if not _computers else [])
    computing._free = deque(_computers)
    computing.warm = start_none  # type: ignore[method-assign]
    computing.close = lambda: None  # type: ignore[method-assign]


@pytest.fixture(scope="session")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    """One server for all tests that leave it as they find it."""
    with serving(tmp_path_factory.mktemp("shared")) as live:
        yield live


@pytest.fixture(scope="session")
def loaded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Forks]:
    """Servers as processes of their own: ``with loaded.serve(folder) as served``."""
    with forks(tmp_path_factory.mktemp("forks") / "log") as program:
        yield program


@pytest.fixture(scope="session")
def shared_on_the_wall(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    """One server by the clock of the machine."""
    with serving(tmp_path_factory.mktemp("wall"), clock="machine") as live:
        yield live


@pytest.fixture
def live(shared: Live) -> Iterator[Live]:
    """The shared server; benches a test has made are closed behind it."""
    yield shared
    close_benches(shared)


@pytest.fixture
def on_the_wall(shared_on_the_wall: Live) -> Iterator[Live]:
    """The shared server by the clock of the machine, for the tests that `tests/wall_clock.txt` lists."""
    yield shared_on_the_wall
    close_benches(shared_on_the_wall)


def close_benches(live: Live) -> None:
    """Close all benches of a server."""
    for bench in live.http.get("/api/v1/benches").json()["benches"]:
        live.http.delete(f"/api/v1/benches/{bench['id']}")


@pytest.fixture
def serve(tmp_path: Path) -> Any:
    """A separate server, with other settings: ``with serve(max_benches=2) as live``."""
    return lambda **fields: serving(fields.pop("folder", tmp_path), **fields)
