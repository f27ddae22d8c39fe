"""Put a class on a server of our own, and say whether it kept its promises.

Students join one after another as fast as the server admits them, each opens the stream of the own bench and commands
it now and then; a teacher's grid asks for all of them every second; further pages watch one more bench.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

import httpx
from load import Server, command, percentile, report, under
from watcher import Watcher

ROOT = Path(__file__).resolve().parents[1]
GRID_S = 1.0
COMMAND: dict[str, object] = {"set": {"controllers.mrac.adaptation_gain": 1.0}}


async def watch(server: Server, bench: str, secret: str, told: dict[str, object]) -> Watcher:
    """Open a stream and wait for its first picture."""
    watcher = Watcher(f"ws://{server.address}/api/v1/benches/{bench}/stream", secret, told)
    await asyncio.get_running_loop().create_connection(lambda: watcher, "127.0.0.1", server.port)
    await watcher.seen.wait()
    return watcher


async def join(server: Server, client: httpx.AsyncClient, group: dict[str, Any], name: str) -> tuple[Watcher, float]:
    """Let a student join; return the stream, and the time from the code to the first picture."""
    began = time.monotonic()
    headers = {"Origin": f"http://{server.address}"}
    path, given = f"/api/v1/classes/{group['id']}/join", {"code": group["code"], "name": name}
    answer = await client.post(path, json=given, headers=headers)
    answer.raise_for_status()
    joined = answer.json()
    return await watch(server, joined["bench"], joined["session"], COMMAND), time.monotonic() - began


async def browse(server: Server, code: str, count: int, seconds: float) -> asyncio.subprocess.Process | None:
    """Let browsers join as students and stay; each draws its bench in software.

    Browsers of students have machines of their own. Here they yield to the server; started by root, Chromium would
    raise its own priority above the server's.
    """
    if not count:
        return None
    told = [f"http://{server.address}", code.replace(" ", ""), str(count), str(seconds)]
    command: list[str | Path] = [
        *(["setpriv", "--bounding-set=-sys_nice"] if os.geteuid() == 0 else []),
        *("nice", "-n", "10"),
        ROOT / "scripts" / "npm",
        "exec",
        "--silent",
        "--",
        "node",
        "measure/students.mjs",
        *told,
    ]
    return await asyncio.create_subprocess_exec(*command, cwd=ROOT / "web", stdout=asyncio.subprocess.PIPE)


async def look(client: httpx.AsyncClient, path: str, taken_ms: list[float]) -> None:
    """Ask for the grid, as the teacher's page does, until cancelled."""
    while True:
        began = time.monotonic()
        (await client.get(path)).raise_for_status()
        taken_ms.append(1e3 * (time.monotonic() - began))
        await asyncio.sleep(GRID_S)


async def hold(server: Server, told: argparse.Namespace) -> dict[str, Any]:
    """Hold the class and return the measurements."""
    teacher = server.http
    bench = teacher.post("/api/v1/benches", json={"scenario": "first-look"}).json()
    group = teacher.post("/api/v1/classes", json={"name": "Load"}).json()
    headers = {"Authorization": f"Bearer {server.token}"}
    base: dict[str, Any] = {"base_url": f"http://{server.address}", "trust_env": False, "timeout": 60.0}
    async with httpx.AsyncClient(**base) as client, httpx.AsyncClient(headers=headers, **base) as grid:
        joined = await asyncio.gather(
            *(join(server, client, group, f"Student {number}") for number in range(told.students))
        )
        students = [watcher for watcher, _ in joined]
        watchers = [await watch(server, bench["id"], server.token, COMMAND) for _ in range(told.watchers)]
        browsing = await browse(server, group["code"], told.browsers, told.seconds)
        grid_ms: list[float] = []
        path = f"/api/v1/classes/{group['id']}/members"
        tasks = [asyncio.create_task(look(grid, path, grid_ms))]
        tasks += [asyncio.create_task(command(one, i / len(students), told.commands)) for i, one in enumerate(students)]
        await asyncio.sleep(2.0)
        before = await asyncio.to_thread(server.count)
        for one in [*students, *watchers]:
            one.forget()
        memory = []
        while time.monotonic() < before.at + told.seconds:
            memory.append(server.memory_mb())
            await asyncio.sleep(1.0)
        after = await asyncio.to_thread(server.count)
        for task in tasks:
            task.cancel()
        tiles = (await grid.get(path)).json()["members"]
    elapsed = after.at - before.at
    frames = [watcher.frames / elapsed for watcher in students]
    replies = [reply for watcher in students for reply in watcher.replies_ms]
    late = [late for watcher in students for late in watcher.late_ms]
    benches = [teacher.get(f"/api/v1/benches/{tile['bench']}").json() for tile in tiles]
    for one in [*students, *watchers]:
        one.leave()
    browsers = json.loads((await browsing.communicate())[0]) if browsing is not None else []
    return {
        "join_to_trace_p95_s": round(percentile([took for _, took in joined], 0.95), 2),
        "command_reply_p95_ms": round(percentile(replies, 0.95), 1),
        "cut_to_receipt_p95_ms": round(percentile(late, 0.95), 1),
        "frames_per_s_slowest_student": round(min(frames), 1),
        "frames_per_s_slowest_watcher": round(min([one.frames / elapsed for one in watchers] or [float("nan")]), 1),
        "grid_p95_ms": round(percentile(grid_ms, 0.95), 1),
        "overruns": after.overruns - before.overruns,
        "slowest_rate_of_a_bench": round(min(one["achieved_scale"] / one["time_scale"] for one in benches), 3),
        "loop_lag_p99_ms": after.lag_p99_ms(before),
        "rounds_over_0.1_s_late": after.woke_late(before),
        "server_share_of_a_core": round((after.processor_s - before.processor_s) / elapsed, 3),
        "clients_share_of_a_core": round((after.own_s - before.own_s) / elapsed, 3),
        "memory_mb": round(memory[-1]),
        "memory_growth_mb": round(memory[-1] - memory[len(memory) // 2], 1),
        "browsers": browsers,
        "closed": [watcher.closed for watcher in [*students, *watchers] if watcher.closed],
    }


def broken(found: dict[str, Any]) -> list[str]:
    """Name the promises that were not kept."""
    kept = {
        "from the code to a moving trace, p95 <= 3 s": found["join_to_trace_p95_s"] <= 3,
        "effect of a command, p95 <= 250 ms": found["command_reply_p95_ms"] + found["cut_to_receipt_p95_ms"] <= 250,
        "no overrun": found["overruns"] == 0,
        "memory < 1.5 GB, and flat": found["memory_mb"] < 1500 and found["memory_growth_mb"] < 30,
        "nobody is dropped": not found["closed"],
        "every browser shows a moving trace": all(one["joined_s"] for one in found["browsers"]),
    }
    return [promise for promise, is_kept in kept.items() if not is_kept]


def main() -> int:
    """Read the arguments, run, report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--students", type=int, default=30)
    parser.add_argument("--watchers", type=int, default=60, help="of the teacher's bench")
    parser.add_argument(
        "--seconds", type=float, default=180.0, help="histories of students are full after five minutes"
    )
    parser.add_argument("--commands", type=float, default=0.5, help="per second and student")
    parser.add_argument("--browsers", type=int, default=0, help="Chromium that join as well, and draw")
    told = parser.parse_args()
    found = under(lambda server: hold(server, told), told.students + told.watchers + told.browsers)
    return report(found, broken(found))


if __name__ == "__main__":
    sys.exit(main())
