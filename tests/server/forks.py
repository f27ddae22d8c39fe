"""Serves by forking, one server for each line read: all is loaded once, so that a test can start and kill many.

A line is a JSON object: settings of the server, ``largest_file`` in bytes if the disk is to refuse more, and ``log``, a
file for its log. Each server prints its process id, then the output of every server.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx

ROOT = Path(__file__).resolve().parents[2]
TOKEN = "a-token-for-the-tests-only"


class Forks:
    """The other end: starts servers and kills them."""

    def __init__(self, program: subprocess.Popen[str]) -> None:
        self._program = program

    @contextmanager
    def serve(self, data: Path, **more: Any) -> Iterator[Served]:
        """Start a server; it is killed at the end, unless it was before."""
        assert self._program.stdin is not None and self._program.stdout is not None
        self._program.stdin.write(json.dumps({"data": str(data), **more}) + "\n")
        self._program.stdin.flush()
        pid = int(self._program.stdout.readline())
        served = Served(pid, self._program.stdout.readline().removeprefix("CombBench is at ").strip())
        assert served.address.startswith("http"), "the server did not start; its log says why"
        try:
            yield served
        finally:
            served.kill()
            served.http.close()


class Served:
    """One server."""

    def __init__(self, pid: int, link: str) -> None:
        self.pid, self.link, self.address = pid, link, link.partition("/?")[0]
        headers = {"Authorization": f"Bearer {TOKEN}"}
        self.http = httpx.Client(base_url=self.address, headers=headers, timeout=120, trust_env=False)

    def kill(self, how: int = signal.SIGKILL) -> None:
        """Kill it as a power cut would, or let it end by another signal; return once it is gone."""
        try:
            os.kill(self.pid, how)
        except ProcessLookupError:
            return
        while Path(f"/proc/{self.pid}").exists():
            os.sched_yield()


@contextmanager
def forks(log: Path) -> Iterator[Forks]:
    """Load everything once."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with log.open("wb") as errors:
        program = subprocess.Popen(
            [sys.executable, __file__],
            cwd=ROOT,
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=errors,
            text=True,
        )
        try:
            yield Forks(program)
        finally:
            program.communicate(timeout=60)


async def start_none(*_: Any) -> None:
    """Start no process before a request asks for it."""


def main() -> None:
    """Fork a server for each line."""
    from scenarios import kernels  # first: it gives compiled kernels their cache
    from server import app  # noqa: F401
    from server.cli.serve import serve
    from server.computing.computing import Computing
    from server.settings import Settings

    kernels.load()
    kernels.load = lambda: None  # every fork has the kernels of its parent
    kernels.complete = lambda: None  # no fork compiles the others
    Computing.warm = start_none  # type: ignore[method-assign]
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    while line := sys.stdin.readline():
        if os.fork():
            continue
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        sys.stdin.close()
        os.setsid()
        print(os.getpid(), flush=True)
        given = json.loads(line)
        os.umask(0o022)  # its files are to be private for users with the usual mask, too
        if log := given.pop("log", None):
            os.dup2(os.open(log, os.O_WRONLY | os.O_CREAT), 2)
        largest = given.pop("largest_file", None)
        if largest is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))
        serve(Settings(**{"port": 0, "token": TOKEN, **given}))
        os._exit(0)


if __name__ == "__main__":
    main()
