"""Put a server of our own under load on loopback, measure, and say whether it kept its promises.

Every watcher is a WebSocket client that acknowledges each frame and commands now and then; one more subscribes and
never reads. All of them run in this process, whose share of a processor is printed with the server's share.
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
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import uvloop
from watcher import Watcher

SETTLE_S = 1.5
"""Not measured: opening connections, and building at first use."""


def percentile(values: list[float], share: float) -> float:
    """Return the value below which ``share`` of the values are; NaN without values."""
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


COMMANDS: dict[str, dict[str, object] | None] = {
    "time_scale": None,
    "set": {"set": {"controllers.mrac.adaptation_gain": 1.0}},
}
"""Commands of watchers by kind; they leave the bench as it is. The time scale is the scale of the bench."""


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

    def add_bench(self, scale: float) -> dict[str, Any]:
        """Start a bench."""
        answer = self.http.post("/api/v1/benches", json={"scenario": "first-look", "time_scale": scale})
        answer.raise_for_status()
        found: dict[str, Any] = answer.json()
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


async def command(watcher: Watcher, phase: float, per_s: float) -> None:
    """Send commands at a steady pace, until cancelled."""
    await asyncio.sleep(phase / per_s)
    while True:
        watcher.ask()
        await asyncio.sleep(1.0 / per_s)


async def drive(server: Server, told: argparse.Namespace) -> dict[str, Any]:
    """Run the load and return the measurements."""
    loop = asyncio.get_running_loop()
    benches = [server.add_bench(told.scale) for _ in range(told.benches)]
    watchers = []
    for number in range(told.watchers + 1):
        bench = benches[number % len(benches)]["id"]
        address = f"ws://{server.address}/api/v1/benches/{bench}/stream"
        watcher = Watcher(address, server.token, COMMANDS[told.kind] or {"kind": "time_scale", "value": told.scale})
        await loop.create_connection(lambda watcher=watcher: watcher, "127.0.0.1", server.port)  # type: ignore[misc]
        await watcher.opened.wait()
        watchers.append(watcher)
    *watchers, stalled = watchers
    stalled.stop_reading()
    asking = []
    if told.commands:
        phases = enumerate(watchers)
        asking = [asyncio.create_task(command(one, i / len(watchers), told.commands)) for i, one in phases]
    await asyncio.sleep(SETTLE_S)
    before = await asyncio.to_thread(server.count)
    for watcher in watchers:
        watcher.forget()
    memory = []
    while (now := time.monotonic()) < before.at + told.seconds:
        memory.append(server.memory_mb())
        await asyncio.sleep(min(max(1.0, told.seconds / 100), before.at + told.seconds - now))
    frames = [watcher.frames for watcher in watchers]
    after = await asyncio.to_thread(server.count)
    for task in asking:
        task.cancel()
    for watcher in [*watchers, stalled]:
        watcher.leave()
    elapsed = after.at - before.at
    late = [late for watcher in watchers for late in watcher.late_ms]
    replies = [reply for watcher in watchers for reply in watcher.replies_ms]
    device_s = (after.ticks - before.ticks) * benches[0]["dt_ms"] * 1e-3
    settled = memory[len(memory) // 10 :]
    return {
        "frames_per_s_slowest": round(min(frames) / elapsed, 1),
        "frames_per_s_mean": round(sum(frames) / len(frames) / elapsed, 1),
        "cut_to_receipt_p50_ms": round(percentile(late, 0.5), 1),
        "cut_to_receipt_p99_ms": round(percentile(late, 0.99), 1),
        "command_reply_p50_ms": round(percentile(replies, 0.5), 1),
        "command_reply_p99_ms": round(percentile(replies, 0.99), 1),
        "loop_lag_p99_ms": after.lag_p99_ms(before),
        "server_share_of_a_core": round((after.processor_s - before.processor_s) / elapsed, 3),
        "clients_share_of_a_core": round((after.own_s - before.own_s) / elapsed, 3),
        "board_rate": round(device_s / (told.scale * told.benches * elapsed), 4),
        "overruns": after.overruns - before.overruns,
        "memory_mb": round(settled[-1]),
        "memory_growth_mb": round(max(settled[-len(settled) // 4 :]) - settled[0], 1),
        "stalled": stalled.closed or "cut off",
        "closed": [watcher.closed for watcher in watchers if watcher.closed],
    }


def broken(found: dict[str, Any], flat: bool) -> list[str]:
    """Name the promises that were not kept."""
    kept = {
        "every watcher gets 20 frames/s": found["frames_per_s_slowest"] >= 20,
        "no watcher is dropped": not found["closed"],
        "every bench keeps its rate within 1 %": abs(found["board_rate"] - 1) <= 0.01,
        "event loop lag p99 < 20 ms": found["loop_lag_p99_ms"] <= 20,
        "memory is flat within 10 %": not flat or found["memory_growth_mb"] < 0.1 * found["memory_mb"],
    }
    return [promise for promise, is_kept in kept.items() if not is_kept]


def under(load: Callable[[Server], Coroutine[Any, Any, dict[str, Any]]], watchers: int) -> dict[str, Any]:
    """Start a server, put a load on it, stop it; return the measurements."""
    with tempfile.TemporaryDirectory() as folder:
        server = Server(Path(folder), watchers)
        try:
            server.wait_ready()
            return uvloop.run(load(server))
        finally:
            server.stop()


def report(found: dict[str, Any], missed: list[str]) -> int:
    """Print the measurements and the promises that were not kept; return the exit code."""
    print(json.dumps(found, indent=2))
    for promise in missed:
        print(f"not kept: {promise}")
    return 1 if missed else 0


def main() -> int:
    """Read the arguments, run, report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--benches", type=int, default=1)
    parser.add_argument("--watchers", type=int, default=20, help="spread over the benches")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--scale", type=float, default=1.0, help="device seconds per second")
    parser.add_argument("--commands", type=float, default=2.0, help="per second and watcher; each is an event for all")
    parser.add_argument("--kind", choices=COMMANDS, default="time_scale", help="of the commands")
    parser.add_argument("--flat", action="store_true", help="memory must not grow")
    told = parser.parse_args()
    found = under(lambda server: drive(server, told), told.watchers)
    return report(found, broken(found, told.flat))


if __name__ == "__main__":
    sys.exit(main())
