"""Put a server of our own under load on loopback, measure, and say whether it kept its promises.

Every watcher is a real WebSocket client that acknowledges each frame; one more subscribes and never reads.
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
import struct
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

FRAME_HEADER = struct.Struct("<BBHIdd")
SIGNALS = ["reference.voltage", "drive.voltage", "plant.displacement", "sensor.displacement"]
SUBSCRIBE = {
    "type": "subscribe",
    "panel": 1,
    "signals": SIGNALS,
    "mode": "roll",
    "window_ms": 4,
    "width": 800,
}


def percentile(values: list[float], share: float) -> float:
    """Return the value below which ``share`` of the values lie; NaN of none."""
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


@dataclass
class Watcher:
    """One page's stream, and what it saw."""

    address: str
    token: str
    scale: float
    frames: int = 0
    gaps_ms: list[float] = field(default_factory=list)
    replies_ms: list[float] = field(default_factory=list)
    closed: str = ""

    def open(self) -> connect:
        """Open the stream."""
        bearer = {"Authorization": f"Bearer {self.token}"}
        return connect(
            self.address,
            additional_headers=bearer,
            subprotocols=[Subprotocol("combbench.v1")],
            compression=None,
            proxy=None,
        )

    async def watch(self, seconds: float) -> None:
        """Take and acknowledge frames; twice a second send a command that changes nothing."""
        async with self.open() as stream:
            await stream.send(json.dumps(SUBSCRIBE))
            asking = asyncio.create_task(self._ask(stream))
            with suppress(TimeoutError):
                async with asyncio.timeout(seconds):
                    await self._take(stream)
                    self.closed = f"{stream.close_code} {stream.close_reason}"
            asking.cancel()

    async def stall(self, seconds: float) -> None:
        """Subscribe, then never read again."""
        async with self.open() as stream:
            await stream.send(json.dumps(SUBSCRIBE))
            stream.transport.pause_reading()
            await asyncio.sleep(seconds)
            stream.transport.abort()

    async def _take(self, stream: ClientConnection) -> None:
        last = 0.0
        async for message in stream:
            now = time.monotonic()
            if isinstance(message, bytes):
                number = FRAME_HEADER.unpack_from(message)[3]
                await stream.send(json.dumps({"type": "ack", "frame": number}))
                self.frames += 1
                if last:
                    self.gaps_ms.append(1e3 * (now - last))
                last = now
            elif (said := json.loads(message))["type"] == "reply":
                self.replies_ms.append(1e3 * (now - float(said["id"])))

    async def _ask(self, stream: ClientConnection) -> None:
        command = {"kind": "time_scale", "value": self.scale}
        while True:
            await stream.send(json.dumps({"type": "command", "id": str(time.monotonic()), "command": command}))
            await asyncio.sleep(0.5)


class Server:
    """A server of our own: free port, own token, a data folder that is thrown away."""

    def __init__(self, data: Path, watchers: int) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self.token = secrets.token_urlsafe(32)
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

    def add_bench(self, scale: float) -> str:
        """Start a bench and return its id."""
        answer = self.http.post("/api/v1/benches", json={"scenario": "first-look", "time_scale": scale})
        answer.raise_for_status()
        return str(answer.json()["id"])

    def benches(self) -> list[dict[str, Any]]:
        """Return the state of every bench."""
        found: list[dict[str, Any]] = self.http.get("/api/v1/benches").json()["benches"]
        return found

    def lag_p99_ms(self) -> float:
        """Return the upper edge of the histogram bucket that holds 99 % of the event loop's lateness."""
        text = self.http.get("/metrics").text
        found = re.findall(r'combbench_event_loop_lag_seconds_bucket\{le="([^"]+)"\} (\S+)', text)
        buckets = [(float(edge), float(count)) for edge, count in found]
        return next((1e3 * edge for edge, count in buckets if count >= 0.99 * buckets[-1][1]), float("inf"))

    def memory_mb(self) -> float:
        """Return the resident memory, where the machine tells it."""
        status = Path(f"/proc/{self.process.pid}/status")
        found = re.search(r"VmRSS:\s+(\d+)", status.read_text()) if status.exists() else None
        return int(found[1]) / 1024 if found else float("nan")

    def stop(self) -> None:
        """Ask it to stop, and wait."""
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(15)


async def drive(server: Server, told: argparse.Namespace) -> dict[str, Any]:
    """Run the load and return the measurements."""
    ids = [server.add_bench(told.scale) for _ in range(told.benches)]
    streams = [f"ws://{server.address}/api/v1/benches/{ids[i % len(ids)]}/stream" for i in range(told.watchers + 1)]
    watchers = [Watcher(stream, server.token, told.scale) for stream in streams]
    memory: list[float] = []
    await asyncio.sleep(1.0)  # what is compiled or built at first use is not the load
    overruns = sum(bench["overruns"] for bench in await asyncio.to_thread(server.benches))

    async def sample() -> None:
        while True:
            memory.append(server.memory_mb())
            await asyncio.sleep(max(1.0, told.seconds / 100))

    sampling = asyncio.create_task(sample())
    start = time.monotonic()
    async with asyncio.TaskGroup() as group:
        group.create_task(watchers[-1].stall(told.seconds))
        for watcher in watchers[:-1]:
            group.create_task(watcher.watch(told.seconds))
    elapsed = time.monotonic() - start
    sampling.cancel()
    benches = await asyncio.to_thread(server.benches)
    settled = memory[len(memory) // 10 :]
    gaps = [gap for watcher in watchers for gap in watcher.gaps_ms]
    replies = [reply for watcher in watchers for reply in watcher.replies_ms]
    return {
        "frames_per_s_slowest": round(min(w.frames for w in watchers[:-1]) / elapsed, 1),
        "frame_gap_p99_ms": round(percentile(gaps, 0.99), 1),
        "command_reply_p50_ms": round(percentile(replies, 0.5), 1),
        "command_reply_p99_ms": round(percentile(replies, 0.99), 1),
        "loop_lag_p99_ms": server.lag_p99_ms(),
        "achieved_scale": [bench["achieved_scale"] for bench in benches],
        "overruns": sum(bench["overruns"] for bench in benches) - overruns,
        "memory_mb": round(settled[-1]),
        "memory_growth_mb": round(max(settled[-len(settled) // 4 :]) - settled[0], 1),
        "closed": [w.closed for w in watchers if w.closed],
    }


def broken(found: dict[str, Any], told: argparse.Namespace) -> list[str]:
    """Name the promises that were not kept."""
    kept = {
        "every watcher gets 20 frames/s": found["frames_per_s_slowest"] >= 20,
        "no watcher is dropped": not found["closed"],
        "every bench keeps its rate within 1 %": all(
            abs(rate / told.scale - 1) <= 0.01 for rate in found["achieved_scale"]
        ),
        "event loop lag p99 < 20 ms": found["loop_lag_p99_ms"] <= 20,
        "memory is flat within 10 %": not told.flat or found["memory_growth_mb"] < 0.1 * found["memory_mb"],
    }
    return [promise for promise, is_kept in kept.items() if not is_kept]


def main() -> int:
    """Read the arguments, run, report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--benches", type=int, default=1)
    parser.add_argument("--watchers", type=int, default=20, help="spread over the benches")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--scale", type=float, default=1.0, help="device seconds per second")
    parser.add_argument("--flat", action="store_true", help="memory must not grow")
    told = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        server = Server(Path(folder), told.watchers)
        try:
            server.wait_ready()
            found = asyncio.run(drive(server, told))
        finally:
            server.stop()
    print(json.dumps(found, indent=2))
    missed = broken(found, told)
    for promise in missed:
        print(f"not kept: {promise}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
