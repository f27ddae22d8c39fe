"""A real server on loopback, spoken to by HTTP and WebSocket."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.sync.client import ClientConnection, connect

from server.app import create_app
from server.serve import bind, make_server
from server.settings import Settings
from server.stream.codec import Frame, decode
from server.stream.wire import SUBPROTOCOL

TOKEN = "a-token-for-the-tests-only"


class Stream:
    """One WebSocket to a bench, with what came over it sorted by type."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self.frames: list[Frame] = []
        self.messages: list[dict[str, Any]] = []
        self.acks = True

    def send(self, **message: Any) -> None:
        self.connection.send(json.dumps(message))

    @property
    def events(self) -> list[dict[str, Any]]:
        """Every event that has come, in the order it came."""
        return [event for m in self.messages if m["type"] == "events" for event in m["events"]]

    def until_event(self, timeout: float = 60.0, **fields: Any) -> dict[str, Any]:
        """Return the first event with these fields: one that has come already, or else one that comes."""

        def found() -> list[dict[str, Any]]:
            return [event for event in self.events if fields.items() <= event.items()]

        if not found():
            self.until(lambda _: bool(found()), timeout)
        return found()[0]

    def step(self, timeout: float = 30.0) -> dict[str, Any] | Frame:
        """Take one message; acknowledge frames unless told not to."""
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

    def until(self, what: Callable[[Any], bool], timeout: float = 60.0) -> Any:
        """Take messages until one is as asked."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            message = self.step(end - time.monotonic())
            if what(message):
                return message
        raise TimeoutError("it never came")

    def until_type(self, kind: str, timeout: float = 60.0, **fields: Any) -> dict[str, Any]:
        found: dict[str, Any] = self.until(
            lambda m: (
                isinstance(m, dict)
                and m["type"] == kind
                and all(m.get(name) == value for name, value in fields.items())
            ),
            timeout,
        )
        return found

    def until_frame(self, panel: int | None = None, timeout: float = 60.0) -> Frame:
        found: Frame = self.until(
            lambda m: isinstance(m, Frame) and (panel is None or any(p.panel == panel for p in m.panels)),
            timeout,
        )
        return found

    def drain(self, seconds: float) -> None:
        """Take whatever comes for a while."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            try:
                self.step(left)
            except TimeoutError:
                return

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

    def until(self, bench_id: str, what: Callable[[dict[str, Any]], bool], seconds: float = 60.0) -> None:
        """Wait until something holds of a bench, however slow the machine is."""
        end = time.monotonic() + seconds
        while not what(self.get(bench_id)):
            assert time.monotonic() < end, self.get(bench_id)
            time.sleep(0.05)

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
            "compression": None,
        }
        url = self.address.replace("http", "ws") + f"/api/v1/benches/{bench_id}/stream"
        with connect(url, **{**given, **options}) as connection:
            yield Stream(connection)


@contextmanager
def serving(folder: Path, **fields: Any) -> Iterator[Live]:
    """Serve from a thread, on a free port, until the test is over."""
    generous = {"command_rate_per_s": 10_000.0, "command_burst": 10_000, "max_benches": 64}
    usual = {"port": 0, "data": folder, "token": TOKEN, "figures": False}
    settings = Settings(**{**usual, **generous, **fields})
    app = create_app(settings)
    listener = bind(settings)
    server = make_server(settings, app)
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    thread.start()
    while not server.started:
        assert thread.is_alive(), "the server did not start"
        time.sleep(0.01)
    live = Live(app, server, f"http://127.0.0.1:{listener.getsockname()[1]}")
    try:
        yield live
    finally:
        live.http.close()
        server.should_exit = True
        thread.join(90)
        assert not thread.is_alive(), "the server did not stop"


@pytest.fixture(scope="session")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    """One server for all tests that leave it as they find it."""
    with serving(tmp_path_factory.mktemp("shared")) as live:
        yield live


@pytest.fixture
def live(shared: Live) -> Iterator[Live]:
    """The shared server; benches a test has made are closed behind it."""
    yield shared
    for bench in shared.http.get("/api/v1/benches").json()["benches"]:
        shared.http.delete(f"/api/v1/benches/{bench['id']}")


@pytest.fixture
def serve(tmp_path: Path) -> Any:
    """A server of one's own, with other settings: ``with serve(max_benches=2) as live``."""
    return lambda **fields: serving(fields.pop("folder", tmp_path), **fields)
