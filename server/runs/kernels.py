"""Compiles kernels while the server already answers."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import re
import signal
import sys

from scenarios import kernels

log = logging.getLogger(__name__)

PROGRESS = re.compile(rb"(\d+) of (\d+)")


class Kernels:
    """Loads the kernels of the first bench before the server serves anyone, and compiles all others meanwhile."""

    def __init__(self) -> None:
        self.are_loaded = False
        self.done, self.total = 0, 0
        self._task: asyncio.Task[None] | None = None

    async def start(self) -> None:
        """Load the kernels of the first bench, and start compiling the rest unless the cache has them."""
        await asyncio.to_thread(kernels.load)
        self.are_loaded = True
        complete = kernels.complete()
        if complete is not None and not complete.exists():
            self._task = asyncio.create_task(self._compile())

    async def _compile(self) -> None:
        """Run the compiler in a process of its own, and log its progress at each quarter."""
        process = await asyncio.create_subprocess_exec(
            sys.executable,
            "-m",
            "scenarios.kernels",
            "behind",
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.DEVNULL,
            start_new_session=True,  # so that the compiler's processes end with it
        )
        assert process.stdout is not None
        reported = 0
        try:
            while text := await process.stdout.read(4096):
                for match in PROGRESS.finditer(text):
                    self.done, self.total = int(match[1]), int(match[2])
                if self.total and 4 * self.done // self.total > reported:
                    reported = 4 * self.done // self.total
                    log.info("compiled %d of %d kernels", self.done, self.total)
            if await process.wait() != 0:
                log.warning("kernels could not be compiled ahead; each is compiled when it is used")
        finally:
            with contextlib.suppress(ProcessLookupError):
                if os.name == "posix":
                    os.killpg(process.pid, signal.SIGTERM)
                else:
                    process.terminate()
            await process.wait()

    async def compiled(self) -> None:
        """Wait until all kernels are compiled, or cannot be."""
        if self._task is not None:
            await asyncio.wait([self._task])

    async def stop(self) -> None:
        """End the compiler."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
