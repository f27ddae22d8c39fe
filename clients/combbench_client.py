"""A Python client of a CombBench server: runs, campaigns, live benches and their stream, in one file to copy.

It needs Python 3.11 and numpy; the stream needs the package websockets too.

    from combbench_client import Client

    lab = Client("http://127.0.0.1:8000", token="...")
    run = lab.run("ch5-seven-step", seed=7)
    trace = lab.trace(run, "plant.displacement")
"""

from __future__ import annotations

import contextlib
import http.client
import io
import itertools
import json
import os
import struct
import time
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

FRAME, PANEL = struct.Struct("<BBHIddd"), struct.Struct("<HHIddddII")
WIRE = 2


class Refused(Exception):
    """What the server says of a request it refuses: a word for programs, the field at fault, advice."""

    def __init__(self, code: str, message: str, field: str = "", hint: str = "") -> None:
        super().__init__(message)
        self.code, self.field, self.hint = code, field, hint


class Picture(NamedTuple):
    """What a bench shows of some signals: minima and maxima of each column of ticks, and the newest values."""

    head: int
    dt_ms: float
    start: float
    end: float
    low: dict[str, Any]
    high: dict[str, Any]
    latest: dict[str, float]


class Client:
    """A server; the token is read from COMBBENCH_TOKEN unless given."""

    def __init__(self, address: str = "http://127.0.0.1:8000", token: str | None = None) -> None:
        self.address = address.rstrip("/") + "/api/v1"
        self.token = os.environ.get("COMBBENCH_TOKEN", "") if token is None else token

    def ask(self, method: str, path: str, body: Any = None, **query: Any) -> Any:
        """Ask for a path below /api/v1; return JSON as Python values, anything else as bytes."""
        with self._open(method, path, body, **query) as answer:
            return _content(answer)

    def pages(self, path: str, **query: Any) -> Iterator[Any]:
        """Return the pages of a list, one after the other; ``limit`` is the number of rows of each."""
        following: dict[str, Any] | None = query
        while following is not None:
            with self._open("GET", path, **following) as answer:
                yield _content(answer)
                link = answer.headers.get("Link", "")
            address = link.partition("<")[2].partition(">")[0]
            following = urllib.parse.parse_qs(urllib.parse.urlsplit(address).query) if address else None

    def _open(self, method: str, path: str, body: Any = None, **query: Any) -> Any:
        headers = {"Authorization": f"Bearer {self.token}", "Content-Type": "application/json"}
        address = self.address + path + (f"?{urllib.parse.urlencode(query, doseq=True)}" if query else "")
        data = None if body is None else json.dumps(body).encode()
        try:
            return urllib.request.urlopen(urllib.request.Request(address, data, headers, method=method))
        except urllib.error.HTTPError as refused:
            said = json.loads(refused.read())["error"]
            raise Refused(said["code"], said["message"], said["field"], said["hint"]) from None

    def run(self, scenario: Any, **fields: Any) -> dict[str, Any]:
        """Run a library id, TOML text or a document headless, to its end; ``set``, ``seed``, ``seeds`` are fields."""
        return self._ended("/runs", self.ask("POST", "/runs", {"scenario": scenario, **fields}))

    def trace(self, run: dict[str, Any], *signals: str, **query: Any) -> dict[str, Any]:
        """Return signals of a run as arrays, with ``tick`` and ``time_ms``; all of them if none is named."""
        query |= {"format": "npz"} | ({"signals": signals} if signals else {})
        with np.load(io.BytesIO(self.ask("GET", f"/runs/{run['id']}/trace", **query))) as file:
            return dict(file)

    def sweep(self, campaign: dict[str, Any], **fields: Any) -> dict[str, Any]:
        """Carry out a campaign, to its end."""
        return self._ended("/sweeps", self.ask("POST", "/sweeps", {"sweep": campaign, **fields}))

    def points(self, sweep: dict[str, Any], **query: Any) -> list[dict[str, Any]]:
        """Return the points of a campaign with their figures: all of them, or the first ``limit``."""
        pages = self.pages(f"/sweeps/{sweep['id']}/points", **query)
        return [point for page in itertools.islice(pages, 1 if "limit" in query else None) for point in page["points"]]

    def bench(self, scenario: Any, **fields: Any) -> Bench:
        """Make a live bench; with ``paused=True`` it stands still until it is stepped."""
        return Bench(self, self.ask("POST", "/benches", {"scenario": scenario, **fields})["id"])

    def watch(self, path: str) -> Iterator[tuple[str, dict[str, Any]]]:
        """Return the events of work under way, such as ``/runs/<id>``, with their data: how far it is, last its end."""
        event = ""
        with self._open("GET", f"{path}/progress") as answer:
            for line in answer:
                name, _, value = line.decode().rstrip("\n").partition(": ")
                if name == "event":
                    event = value
                elif name == "data":
                    yield event, json.loads(value)

    def _ended(self, kind: str, thing: dict[str, Any]) -> dict[str, Any]:
        path = f"{kind}/{thing['id']}"
        while thing["state"] in ("queued", "running"):
            # A server may be too old for such streams, or have too many open; a stream may break off.
            with contextlib.suppress(Refused, OSError, http.client.HTTPException):
                for event, data in self.watch(path):
                    thing = thing if event == "progress" else data
            if thing["state"] in ("queued", "running"):
                time.sleep(0.1)
                thing = self.ask("GET", path)
        if thing["state"] != "done":
            raise Refused(thing["state"], (thing["error"] or {}).get("message", thing["state"]))
        return thing


class Bench:
    """A live bench; a context that closes it at its end."""

    def __init__(self, lab: Client, bench_id: str) -> None:
        self.lab, self.id, self.path = lab, bench_id, f"/benches/{bench_id}"

    def __enter__(self) -> Bench:
        return self

    def __exit__(self, *_: object) -> None:
        self.lab.ask("DELETE", self.path)

    def command(self, **fields: Any) -> dict[str, Any]:
        """Do something to it: ``kind="step", ticks=100``, ``fault=..., severity=...``, ``switch=...``, ``set=...``."""
        found: dict[str, Any] = self.lab.ask("POST", f"{self.path}/commands", fields)
        return found

    def pictures(self, *signals: str, window_ms: float, width: int = 800) -> Iterator[Picture]:
        """Return what it shows of some signals over the last so many ms, again and again, until it is closed."""
        from websockets.sync.client import connect
        from websockets.typing import Subprotocol

        address = f"ws{self.lab.address.removeprefix('http')}{self.path}/stream"
        headers = {"Authorization": f"Bearer {self.lab.token}"}
        panel = {"panel": 1, "signals": signals, "mode": "roll", "window_ms": window_ms, "width": width}
        protocol = Subprotocol(f"combbench.v{WIRE}")
        with connect(address, additional_headers=headers, subprotocols=[protocol], max_size=None) as stream:
            stream.send(json.dumps({"type": "subscribe", **panel}))
            for data in stream:
                if isinstance(data, bytes):
                    wire, _, count, frame, head, dt_ms, _ = FRAME.unpack_from(data)
                    stream.send(json.dumps({"type": "ack", "frame": frame}))
                    if wire == WIRE and count:
                        yield _picture(data, signals, int(head), dt_ms)
                elif (said := json.loads(data))["type"] == "error":
                    raise Refused(said["error"]["code"], said["error"]["message"], said["error"]["field"])
                elif said["type"] == "ping":
                    stream.send(json.dumps({"type": "pong"}))


def _content(answer: Any) -> Any:
    """Read an answer."""
    found = answer.read()
    return json.loads(found) if found and answer.headers.get_content_type() == "application/json" else found


def _picture(data: bytes, signals: tuple[str, ...], head: int, dt_ms: float) -> Picture:
    """Read the first panel of a frame."""
    _, count, columns, start, end, *_ = PANEL.unpack_from(data, FRAME.size)
    numbers = np.frombuffer(data, "<f4", count * (2 * columns + 1), FRAME.size + PANEL.size)
    drawn, latest = numbers[: 2 * count * columns].reshape(count, 2, columns), numbers[2 * count * columns :]
    low, high = ({name: drawn[row, k] for row, name in enumerate(signals)} for k in (0, 1))
    return Picture(head, dt_ms, start, end, low, high, dict(zip(signals, latest.tolist(), strict=True)))
