"""A Dask scheduler and workers as processes of their own, to be killed."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
from pathlib import Path
from typing import IO, Any

ROOT = Path(__file__).resolve().parents[3]


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


def read_to_end(stream: IO[bytes]) -> None:
    with stream:
        stream.read()


class Cluster:
    """One scheduler and its workers."""

    def __init__(self, folder: Path) -> None:
        self.port = free_port()
        self.address = f"tcp://127.0.0.1:{self.port}"
        self._folder, self._log = folder, (folder / "dask.log").open("ab")
        self.workers: list[subprocess.Popen[bytes]] = []
        self.scheduler = self.start_scheduler()

    def _start(self, *command: str, log: int | IO[bytes]) -> subprocess.Popen[bytes]:
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "DASK_DISTRIBUTED__ADMIN__TICK__LIMIT": "1h"}
        command = (sys.executable, "-m", "dask", *command, "--no-dashboard")
        return subprocess.Popen(command, cwd=self._folder, env=environment, stdout=self._log, stderr=log)

    def start_scheduler(self) -> subprocess.Popen[bytes]:
        """Start the scheduler; it listens once its log says so."""
        command = ("scheduler", "--host", "127.0.0.1", "--port", str(self.port))
        self.scheduler = self._start(*command, log=subprocess.PIPE)
        assert self.scheduler.stderr is not None
        assert any(b"Scheduler at" in line for line in self.scheduler.stderr), "the scheduler did not start"
        threading.Thread(target=read_to_end, args=(self.scheduler.stderr,), daemon=True).start()
        return self.scheduler

    def start_worker(self) -> subprocess.Popen[bytes]:
        options = ("--nthreads", "1", "--no-nanny", "--death-timeout", "60")
        worker = self._start("worker", self.address, *options, log=self._log)
        self.workers.append(worker)
        return worker

    def __enter__(self) -> Cluster:
        return self

    def __exit__(self, *_: Any) -> None:
        for process in (*self.workers, self.scheduler):
            if process.poll() is None:
                process.kill()
            process.wait()
        self._log.close()
