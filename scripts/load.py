"""Put a server of our own under load on loopback, measure, and say whether it kept its promises.

``pages`` watch some benches: each is a WebSocket client that acknowledges every frame and commands now and then; one
more subscribes and never reads. In a ``class`` students join one after another as fast as the server admits them, each
opens the stream of the own bench and commands it; a teacher's grid asks for all of them every second; further pages
watch one more bench. All clients run in this process, whose share of a processor is printed with the server's share.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import re
import secrets
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Coroutine
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import uvloop
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

from server.stream.codec import HEADER
from server.stream.wire import SUBPROTOCOL

SETTLE_S = 2.0
"""Not measured: opening connections, and building at first use."""
COMMAND = {"set": {"controllers.mrac.adaptation_gain": 1.0}}
"""What watchers send; it leaves the bench as it is."""
SIGNALS = ["reference.voltage", "drive.voltage", "plant.displacement", "sensor.displacement"]
SUBSCRIBE = {"type": "subscribe", "panel": 1, "signals": SIGNALS, "mode": "roll", "window_ms": 4, "width": 800}


def percentile(values: list[float], share: float) -> float:
    """Return the value below which ``share`` of the values are; NaN without values."""
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


class Server:
    """A server of our own: free port, own token, a data folder that is thrown away."""

    def __init__(self, data: Path, watchers: int) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.token, self.port = secrets.token_urlsafe(32), port
        self.address = f"127.0.0.1:{port}"
        limits = {"MAX_CLIENTS": str(watchers + 1), "MAX_CLIENTS_PER_BENCH": str(watchers + 1)}
        told = {"PORT": str(port), "TOKEN": self.token, "DATA": str(data), "LOG_LEVEL": "WARNING", **limits}
        command = [str(Path(sys.executable).parent / "combbench"), "serve"]
        self.process = subprocess.Popen(
            command,
            env=os.environ | {f"COMBBENCH_{k}": v for k, v in told.items()},
            stdout=subprocess.DEVNULL,
        )
        self.http = httpx.Client(
            base_url=f"http://{self.address}",
            headers={"Authorization": f"Bearer {self.token}"},
            trust_env=False,
        )

    def wait_ready(self) -> None:
        """Wait until it answers, for at most 30 s."""
        for _ in range(300):
            with suppress(httpx.TransportError):
                if self.http.get("/health/ready").is_success:
                    return
            time.sleep(0.1)
        raise SystemExit("the server did not become ready")

    def post(self, path: str, body: dict[str, Any]) -> dict[str, Any]:
        """Post as the teacher."""
        found: dict[str, Any] = self.http.post(path, json=body).raise_for_status().json()
        return found

    def get(self, path: str) -> dict[str, Any]:
        """Get as the teacher."""
        found: dict[str, Any] = self.http.get(path).raise_for_status().json()
        return found

    def count(self) -> Counts:
        """Return the counts of the server so far."""
        text = self.http.get("/metrics").text
        ticks = re.search(r"^combbench_ticks_total (\S+)", text, re.MULTILINE)
        overruns = re.search(r"^combbench_overruns_total (\S+)", text, re.MULTILINE)
        assert ticks is not None and overruns is not None
        return Counts(
            at=time.monotonic(),
            ticks=float(ticks[1]),
            overruns=float(overruns[1]),
            lag=_histogram(text, "event_loop_lag_seconds"),
            woke=_histogram(text, "engine_wake_lateness_seconds"),
            processor_s=self.processor_s(),
            own_s=time.process_time(),
        )

    def processor_s(self) -> float:
        """Return the processor time it has taken, where the machine tells it."""
        stat = Path(f"/proc/{self.process.pid}/stat")
        if not stat.exists():
            return float("nan")
        user, system = stat.read_text().rpartition(")")[2].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")

    def memory_mb(self) -> float:
        """Return the resident memory, where the machine tells it."""
        status = Path(f"/proc/{self.process.pid}/status")
        found = re.search(r"VmRSS:\s+(\d+)", status.read_text()) if status.exists() else None
        return int(found[1]) / 1024 if found else float("nan")

    def stop(self) -> None:
        """Ask it to stop, and wait."""
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(15)


@dataclass(frozen=True)
class Counts:
    """Totals of the server and of this process up to a moment."""

    at: float
    ticks: float
    overruns: float
    lag: dict[float, float]
    woke: dict[float, float]
    processor_s: float
    own_s: float

    def lag_p99_ms(self, before: Counts) -> float:
        """Return the upper edge of the histogram bucket that holds 99 % of the event loop's lateness since."""
        since = {edge: count - before.lag.get(edge, 0.0) for edge, count in self.lag.items()}
        return next((1e3 * edge for edge, count in since.items() if count >= 0.99 * since[float("inf")]), float("inf"))

    def woke_late(self, before: Counts) -> int:
        """Return how many rounds of the engine began more than 0.1 s late since."""
        late = [of.woke[float("inf")] - of.woke[0.1] for of in (before, self)]
        return int(late[1] - late[0])


def _histogram(text: str, name: str) -> dict[float, float]:
    """Return how many values of a metric are at or below each edge."""
    edges = re.findall(rf'combbench_{name}_bucket\{{le="([^"]+)"\}} (\S+)', text)
    return {float(edge): float(count) for edge, count in edges}


class Watcher:
    """One page's stream, at little cost, so that the server is measured.

    Parameters
    ----------
    line : ClientConnection
        An open stream.
    """

    def __init__(self, line: ClientConnection) -> None:
        self._line, self.seen, self.closed = line, asyncio.Event(), ""
        self.forget()

    def forget(self) -> None:
        """Begin to measure anew."""
        self.frames = 0
        self.late_ms: list[float] = []
        self.replies_ms: list[float] = []

    async def read(self) -> None:
        """Take and acknowledge every frame until the server closes."""
        await self._line.send(json.dumps(SUBSCRIBE))
        try:
            async for message in self._line:
                now = time.monotonic()
                if isinstance(message, bytes):
                    _, _, _, number, _, _, cut_s = HEADER.unpack_from(message)
                    await self._line.send(f'{{"type":"ack","frame":{number}}}')
                    self.frames += 1
                    self.seen.set()
                    self.late_ms.append(1e3 * (now - cut_s))
                elif message.startswith('{"type":"reply"'):
                    self.replies_ms.append(1e3 * (now - float(json.loads(message)["id"])))
        except ConnectionClosed:
            pass
        self.closed = f"{self._line.close_code} {self._line.close_reason}"

    async def command(self, phase: float, per_s: float) -> None:
        """Send commands at a steady pace; their answers tell how long they took."""
        await asyncio.sleep(phase / per_s)
        while not self.closed:
            await self._line.send(json.dumps({"type": "command", "id": str(time.monotonic()), "command": COMMAND}))
            await asyncio.sleep(1.0 / per_s)


async def open_stream(server: Server, bench: str, secret: str) -> ClientConnection:
    """Open the stream of a bench."""
    return await connect(
        f"ws://{server.address}/api/v1/benches/{bench}/stream",
        additional_headers={"Authorization": f"Bearer {secret}"},
        subprotocols=[Subprotocol(SUBPROTOCOL)],
        compression=None,
        proxy=None,
        max_size=None,
        close_timeout=1.0,
    )


class Load:
    """The watchers of a server, and the measurements of both.

    Parameters
    ----------
    server : Server
        The server.
    tasks : asyncio.TaskGroup
        In which they read.
    """

    def __init__(self, server: Server, tasks: asyncio.TaskGroup) -> None:
        self.server, self._group = server, tasks
        self.watchers: list[Watcher] = []
        self._tasks: list[asyncio.Task[None]] = []

    def begin(self, work: Coroutine[Any, Any, None]) -> None:
        """Do something until the load ends."""
        self._tasks.append(self._group.create_task(work))

    async def watch(self, bench: str, secret: str) -> Watcher:
        """Add a watcher, and wait for its first picture."""
        watcher = Watcher(await open_stream(self.server, bench, secret))
        self.watchers.append(watcher)
        self.begin(watcher.read())
        await watcher.seen.wait()
        return watcher

    def command(self, watchers: list[Watcher], per_s: float) -> None:
        """Let watchers command, one after another."""
        for number, watcher in enumerate(watchers if per_s else []):
            self.begin(watcher.command(number / len(watchers), per_s))

    async def measure(self, seconds: float, flat_after: float) -> dict[str, Any]:
        """Measure for a while, then end the load; memory may grow in a first share of the time."""
        await asyncio.sleep(SETTLE_S)
        before = await asyncio.to_thread(self.server.count)
        for watcher in self.watchers:
            watcher.forget()
        memory = []
        while time.monotonic() < before.at + seconds:
            memory.append(self.server.memory_mb())
            await asyncio.sleep(1.0)
        after = await asyncio.to_thread(self.server.count)
        elapsed = after.at - before.at
        frames = [watcher.frames / elapsed for watcher in self.watchers]
        replies = [reply for watcher in self.watchers for reply in watcher.replies_ms]
        late = [late for watcher in self.watchers for late in watcher.late_ms]
        closed = [watcher.closed for watcher in self.watchers if watcher.closed]
        for task in self._tasks:
            task.cancel()
        settled = memory[int(flat_after * len(memory)) :]
        return {
            "frames_per_s_slowest": round(min(frames), 1),
            "cut_to_receipt_p95_ms": round(percentile(late, 0.95), 1),
            "cut_to_receipt_p99_ms": round(percentile(late, 0.99), 1),
            "command_reply_p95_ms": round(percentile(replies, 0.95), 1),
            "command_reply_p99_ms": round(percentile(replies, 0.99), 1),
            "loop_lag_p99_ms": after.lag_p99_ms(before),
            "rounds_over_0.1_s_late": after.woke_late(before),
            "overruns": after.overruns - before.overruns,
            "ticks_per_s": round((after.ticks - before.ticks) / elapsed, 1),
            "server_share_of_a_core": round((after.processor_s - before.processor_s) / elapsed, 3),
            "clients_share_of_a_core": round((after.own_s - before.own_s) / elapsed, 3),
            "memory_mb": round(settled[-1]),
            "memory_growth_mb": round(max(settled[len(settled) // 2 :]) - settled[0], 1),
            "closed": closed,
        }


async def watch_benches(server: Server, given: argparse.Namespace) -> dict[str, Any]:
    """Let pages watch some benches, and one more that never reads."""
    asked = {"scenario": "first-look", "time_scale": given.scale}
    benches = [server.post("/api/v1/benches", asked) for _ in range(given.benches)]
    async with asyncio.TaskGroup() as tasks:
        load = Load(server, tasks)
        for number in range(given.watchers):
            await load.watch(benches[number % len(benches)]["id"], server.token)
        stalled = await open_stream(server, benches[0]["id"], server.token)
        await stalled.send(json.dumps(SUBSCRIBE))
        load.command(load.watchers, given.commands)
        found = await load.measure(given.seconds, 0.1)
        stalled.transport.abort()
    device_s = found.pop("ticks_per_s") * benches[0]["dt_ms"] * 1e-3
    return {**found, "board_rate": round(device_s / (given.scale * given.benches), 4)}


def promises_to_pages(found: dict[str, Any], given: argparse.Namespace) -> dict[str, bool]:
    """Return the promises to pages, and whether each was kept."""
    return {
        "every watcher gets 20 frames/s": found["frames_per_s_slowest"] >= 20,
        "no watcher is dropped": not found["closed"],
        "every bench keeps its rate within 1 %": abs(found["board_rate"] - 1) <= 0.01,
        "event loop lag p99 < 20 ms": found["loop_lag_p99_ms"] <= 20,
        "memory is flat within 10 %": not given.flat or found["memory_growth_mb"] < 0.1 * found["memory_mb"],
    }


async def look(client: httpx.AsyncClient, path: str, taken_ms: list[float]) -> None:
    """Ask for the grid every second, as the teacher's page does."""
    while True:
        began = time.monotonic()
        (await client.get(path)).raise_for_status()
        taken_ms.append(1e3 * (time.monotonic() - began))
        await asyncio.sleep(1.0)


async def hold_class(server: Server, given: argparse.Namespace) -> dict[str, Any]:
    """Let students join and command their benches, while further pages watch one more bench."""
    bench = server.post("/api/v1/benches", {"scenario": "first-look"})
    group = server.post("/api/v1/classes", {"name": "Load"})
    path = f"/api/v1/classes/{group['id']}"
    base: dict[str, Any] = {"base_url": f"http://{server.address}", "trust_env": False, "timeout": 60.0}
    async with asyncio.TaskGroup() as tasks, httpx.AsyncClient(**base) as client:
        load = Load(server, tasks)
        grid_ms: list[float] = []

        async def join(name: str) -> tuple[Watcher, float]:
            began, headers = time.monotonic(), {"Origin": f"http://{server.address}"}
            answer = await client.post(f"{path}/join", json={"code": group["code"], "name": name}, headers=headers)
            joined = answer.raise_for_status().json()
            return await load.watch(joined["bench"], joined["session"]), time.monotonic() - began

        joined = await asyncio.gather(*(join(f"Student {number}") for number in range(given.students)))
        for _ in range(given.watchers):
            await load.watch(bench["id"], server.token)
        load.command([watcher for watcher, _ in joined], given.commands)
        client.headers["Authorization"] = f"Bearer {server.token}"
        load.begin(look(client, f"{path}/members", grid_ms))
        found = await load.measure(given.seconds, 0.5)
        benches = [server.get(f"/api/v1/benches/{tile['bench']}") for tile in server.get(f"{path}/members")["members"]]
    return {
        **found,
        "join_to_trace_p95_s": round(percentile([took for _, took in joined], 0.95), 2),
        "grid_p95_ms": round(percentile(grid_ms, 0.95), 1),
        "slowest_rate_of_a_bench": round(min(one["achieved_scale"] / one["time_scale"] for one in benches), 3),
    }


def promises_to_a_class(found: dict[str, Any], _: argparse.Namespace) -> dict[str, bool]:
    """Return the promises to a class, and whether each was kept."""
    return {
        "from the code to a moving trace, p95 <= 3 s": found["join_to_trace_p95_s"] <= 3,
        "effect of a command, p95 <= 250 ms": found["command_reply_p95_ms"] + found["cut_to_receipt_p95_ms"] <= 250,
        "no overrun": found["overruns"] == 0,
        "memory < 1.5 GB, and flat": found["memory_mb"] < 1500 and found["memory_growth_mb"] < 30,
        "no page is dropped": not found["closed"],
    }


def main() -> int:
    """Read the arguments, run, report; the exit code is 1 when a promise was not kept."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(required=True)
    pages = kinds.add_parser("pages")
    pages.set_defaults(load=watch_benches, promises=promises_to_pages, students=0)
    pages.add_argument("--benches", type=int, default=1)
    pages.add_argument("--watchers", type=int, default=20, help="spread over the benches")
    pages.add_argument("--seconds", type=float, default=20.0)
    pages.add_argument("--scale", type=float, default=1.0, help="device seconds per second")
    pages.add_argument("--commands", type=float, default=2.0, help="per second and page; each is an event for all")
    pages.add_argument("--flat", action="store_true", help="memory must not grow")
    group = kinds.add_parser("class")
    group.set_defaults(load=hold_class, promises=promises_to_a_class)
    group.add_argument("--students", type=int, default=30)
    group.add_argument("--watchers", type=int, default=60, help="of the teacher's bench")
    group.add_argument("--seconds", type=float, default=180.0, help="histories of students are full after five minutes")
    group.add_argument("--commands", type=float, default=0.5, help="per second and student")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        server = Server(Path(folder), given.students + given.watchers)
        try:
            server.wait_ready()
            found = uvloop.run(given.load(server, given))
        finally:
            server.stop()
    print(json.dumps(found, indent=2))
    missed = [promise for promise, is_kept in given.promises(found, given).items() if not is_kept]
    for promise in missed:
        print(f"not kept: {promise}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
