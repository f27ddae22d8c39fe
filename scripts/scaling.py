"""Measure campaigns on this machine: runs per second over workers, the cost of a batch, the size of a table of results.

A cluster is a scheduler and workers of their own, which are reached by TCP on loopback and have a folder each. Figures
are medians; the load of the machine is printed with them, because other work on it slows everything down.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median
from typing import Any

import pyarrow.compute as pc
import pyarrow.parquet as pq

from scenarios.campaign.batch import outcomes
from scenarios.campaign.campaign import Campaign
from scenarios.campaign.outcome import Outcome
from scenarios.campaign.parts import PART, ParquetParts
from scenarios.campaign.survey import Survey
from scenarios.campaign.sweep import Sweep
from scenarios.schema import Scenario
from server.store.database import Database
from server.store.results import Results

ROOT = Path(__file__).resolve().parents[1]
START_S = 90.0


def campaign(runs: int, samples: int) -> Sweep:
    """Return the seven steps with so many seeds."""
    document = {"schema": 1, "scenario": "ch5-seven-step", "set": {"samples": samples}, "seeds": {"count": runs}}
    return Sweep(document)


def say(title: str, **values: object) -> None:
    """Print a row."""
    shown = [f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}" for name, value in values.items()]
    print(f"{title}: {', '.join(shown)}; load {os.getloadavg()[0]:.1f}", flush=True)


# ------------------------------------------------------------------------------------------------- workers


def carry_out(sweep: Sweep, width: int, **where: Any) -> dict[str, float]:
    """Carry a campaign out; return its pace after the first result, and the cost of a batch besides its runs."""
    folder = Path(tempfile.mkdtemp(prefix="combbench-scaling-"))
    database = Database(folder / "results.sqlite3")
    database.migrate()
    results, parts = Results(database), ParquetParts(sweep, folder / "runs")
    seen: list[tuple[float, int]] = []

    def progress(done: int, _total: int) -> None:
        parts.follow(done, results.outcomes)
        seen.append((time.perf_counter(), done))

    try:
        began = time.perf_counter()
        if not Campaign(sweep, results, on_progress=progress, **where).run():
            raise RuntimeError("the campaign did not come to its end")
        parts.keep_up(results.outcomes, to_end=True)
        elapsed = sum(pc.sum(table["elapsed_s"]).as_py() for table in parts.tables(["elapsed_s"]))
        wall, runs = seen[-1][0] - seen[1][0], seen[-1][1] - seen[1][1]
        return {
            "first_s": seen[1][0] - began,
            "runs_per_s": runs / wall,
            "ms_per_run": 1e3 * elapsed / len(sweep),
            "busy": elapsed * runs / len(sweep) / (wall * width),
            "ms_per_batch": 1e3 * (wall * width - elapsed * runs / len(sweep)) / max(1, len(seen) - 2),
        }
    finally:
        database.close()
        shutil.rmtree(folder)


def repeated(title: str, times: int, measure: Callable[[], dict[str, float]]) -> None:
    """Print the medians of some measurements."""
    found = [measure() for _ in range(times)]
    say(title, **{name: median(one[name] for one in found) for name in found[0]})


def free_port() -> int:
    """Return a free port of loopback."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


@contextmanager
def cluster(workers: int, tls: dict[str, str] | None = None) -> Iterator[str]:
    """Start a scheduler and workers, each in a folder of its own; give its address."""
    folder = Path(tempfile.mkdtemp(prefix="combbench-cluster-"))
    port, scheme = free_port(), "tls" if tls else "tcp"
    address = f"{scheme}://127.0.0.1:{port}"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    options = ["--protocol", scheme] if tls else []
    for name, path in (tls or {}).items():
        options += [f"--tls-{name}", path]
    processes: list[subprocess.Popen[bytes]] = []

    def start(name: str, *command: str) -> None:
        own = folder / name
        own.mkdir()
        with (own / "log").open("wb") as log:
            line = [sys.executable, "-m", "dask", *command, *options, "--no-dashboard"]
            processes.append(subprocess.Popen(line, cwd=own, env=environment, stdout=log, stderr=log))

    try:
        start("scheduler", "scheduler", "--host", "127.0.0.1", "--port", str(port))
        for number in range(workers):
            own = folder / f"worker-{number}"
            start(own.name, "worker", address, "--nthreads", "1", "--no-nanny", "--local-directory", str(own))
        _wait_for(address, workers)
        yield address
    finally:
        for process in processes:
            process.kill()
            process.wait()
        shutil.rmtree(folder, ignore_errors=True)


def _wait_for(address: str, workers: int) -> None:
    """Wait until a scheduler has its workers."""
    from distributed import Client

    end = time.monotonic() + START_S
    while True:
        try:
            with Client(address, timeout=5, set_as_default=False) as client:  # type: ignore[no-untyped-call]
                client.wait_for_workers(workers, timeout=START_S)
                return
        except OSError:
            if time.monotonic() > end:
                raise


def measure_workers(runs: int, samples: int, times: int, widths: list[int], cluster_widths: list[int]) -> None:
    """Measure processes of this machine, then a cluster."""
    sweep = campaign(runs, samples)
    for width in widths:
        repeated(f"{width} processes", times, lambda w=width: carry_out(sweep, w, workers=w))  # type: ignore[misc]
    for width in cluster_widths:
        with cluster(width) as address:
            carry_out(campaign(min(runs, 500), samples), width, scheduler=address)  # workers load the kernels
            repeated(
                f"{width} workers of a cluster",
                times,
                lambda w=width, at=address: carry_out(sweep, w, scheduler=at),  # type: ignore[misc]
            )


# --------------------------------------------------------------------------------------------------- table


def measure_table(rows: int, address: str) -> None:
    """Measure what results take in the table and as files, and how long reading takes."""
    sweep = campaign(rows, 50)
    scenario = Scenario.load(sweep.points[0].document)
    made = outcomes([(scenario, seed) for seed in range(1, 257)])
    folder = Path(tempfile.mkdtemp(prefix="combbench-table-"))
    database = Database(address or folder / "results.sqlite3")
    database.migrate()
    results, parts = Results(database), ParquetParts(sweep, folder / "runs")
    try:
        began = time.perf_counter()
        for first in range(0, rows, PART):
            found = [(sweep.key(number), _text(made, number)) for number in range(first, min(first + PART, rows))]
            results.put(found)
        written = time.perf_counter() - began
        keys = [sweep.key(number) for number in range(0, rows, max(1, rows // 5000))]
        looked, _ = timed(lambda: results.have(keys))
        say(f"table of {rows} rows", insert_us=1e6 * written / rows, have_us=1e6 * looked / len(keys))
        began = time.perf_counter()
        parts.keep_up(results.outcomes, to_end=True)
        us = 1e6 * (time.perf_counter() - began) / rows
        size = sum(path.stat().st_size for path in parts.paths())
        place = folder / "results.sqlite3"
        say(
            f"files of {rows} rows",
            write_us=us,
            bytes_a_row=size / rows,
            table_bytes_a_row=place.stat().st_size / rows if place.exists() else _postgres_size(database) / rows,
        )
        measure_reading(sweep, ParquetParts(sweep, folder / "runs"))
    finally:
        database.close()
        shutil.rmtree(folder)


def _text(made: list[Outcome], number: int) -> str:
    """Return an outcome of another seed as the table has it."""
    changed = {"seed": number + 1, "digest": f"{hash((number, 1)) & (2**64 - 1):016x}" * 4}
    return made[number % len(made)].model_copy(update=changed).model_dump_json()


def _postgres_size(database: Database) -> int:
    from sqlalchemy import text

    query = text("SELECT pg_total_relation_size('results')")
    return int(database.transact(lambda session: session.execute(query).scalar()) or 0)


def measure_reading(sweep: Sweep, parts: ParquetParts) -> None:
    """Measure the requests of the page, three times each."""
    figure = "control.rms_error_um"
    asked: dict[str, Callable[[], object]] = {
        "first page": lambda: (lambda survey: survey.page(survey.order()[:200]))(Survey(sweep, parts)),
        "sorted page": lambda: (lambda survey: survey.page(survey.order(figure)[:200]))(Survey(sweep, parts)),
        "histogram": lambda: Survey(sweep, parts).distribution(figure),
        "density": lambda: Survey(sweep, parts).distribution("seed", figure),
    }
    for name, ask in asked.items():
        say(f"{name} of {len(sweep)} runs", ms=1e3 * median(timed(ask)[0] for _ in range(3)))
    folder = parts.paths()[0].parent
    say("all figures of all files", ms=1e3 * timed(lambda: pq.read_table(folder, columns=[figure]))[0])


def timed(ask: Callable[[], object]) -> tuple[float, object]:
    """Call a function; return its time, and its result."""
    began = time.perf_counter()
    answer = ask()
    return time.perf_counter() - began, answer


def measure_memory(count: int, kind: str) -> None:
    """Measure the expansion of a campaign: time to the first run, then memory and time of all keys."""
    from scenarios.campaign.campaign import MAX_BATCH
    from scenarios.campaign.check import check
    from scenarios.campaign.remaining import Remaining

    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    hypercube = {"points": count, "ranges": {"sensor.noise_um": {"min": 0.01, "max": 0.2}}}
    more: dict[str, Any] = {"seeds": {"count": count}} if kind == "seeds" else {"latin_hypercube": hypercube}
    began = time.perf_counter()
    sweep = Sweep({"schema": 1, "scenario": "ch5-seven-step", "set": {"samples": 50}, **more})
    check(sweep)
    remaining = Remaining(sweep, lambda _: set())
    taken = remaining.take(1)
    first = time.perf_counter() - began
    while taken:
        for key, _, _ in taken:
            remaining.finish(key)
        taken = remaining.take(MAX_BATCH)
    seconds = time.perf_counter() - began
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    say(f"expansion of {count} {kind}", first_s=first, s=seconds, peak_mb=grown / 1024)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=["workers", "table", "memory"])
    parser.add_argument("--runs", type=int, default=4000, help="runs of a campaign, or rows of the table")
    parser.add_argument("--samples", type=int, default=9000)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--processes", type=json.loads, default=[1, 2], help="a list")
    parser.add_argument("--workers", type=json.loads, default=[1, 2, 4], help="a list")
    parser.add_argument("--kind", choices=["seeds", "points"], default="seeds")
    parser.add_argument("--database", default="", help="address of PostgreSQL; SQLite in a temporary folder without")
    given = parser.parse_args()
    if given.what == "workers":
        measure_workers(given.runs, given.samples, given.repeat, given.processes, given.workers)
    elif given.what == "table":
        measure_table(given.runs, given.database)
    else:
        measure_memory(given.runs, given.kind)


if __name__ == "__main__":
    main()
