"""Executors of runs: processes of this machine, or a Dask cluster by its address."""

from __future__ import annotations

import gc
import importlib
import multiprocessing
import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import forkserver
from typing import Any, TypeVar

from core.wall import wall
from scenarios import record_folders
from scenarios.campaign.progress import Signs, receive, watched

LOST: tuple[type[BaseException], ...] = (BrokenProcessPool, CancelledError, OSError)
"""Errors of a future or a connection after a worker, the scheduler or the line to it is lost."""
LOADED = "scenarios.campaign.loaded"
_preloaded = [LOADED]
T = TypeVar("T")


class Processes(Executor):
    """Processes of this machine, which several campaigns may share; when one dies, all are started anew.

    Parameters
    ----------
    workers : int
        How many.
    niceness : int
        Their niceness.
    """

    def __init__(self, workers: int, niceness: int = 0) -> None:
        self.width = workers
        count = 4 * workers * (workers + 2)  # each process works for a campaign of its own, which hands over more ahead
        self._signs, self._free = Signs(count), deque(range(count))
        self._niceness = niceness
        self._places: dict[Future[Any], int] = {}
        self._pool: ProcessPoolExecutor | None = None
        self._lock = threading.Lock()

    def submit(self, function: Callable[..., T], /, *arguments: Any, **named: Any) -> Future[T]:
        """Give a piece of work to the processes; the first piece starts them.

        Raises
        ------
        BrokenProcessPool
            When a process died just now, or could not be started.
        """
        assert not named
        with self._lock:
            pool = self._pool = self._pool or self._start()
            place = self._free.popleft()
            self._signs.ticks[place] = self._signs.stop[place] = 0
            try:
                future = pool.submit(_with_records, record_folders.folders(), place, function, *arguments)
            except (BrokenProcessPool, OSError, EOFError) as error:
                self._free.append(place)
                self._pool = None
                raise BrokenProcessPool("a process could not be started") from error
            self._places[future] = place
        future.add_done_callback(lambda future: self._release(future, pool))
        return future

    def ticks(self, future: Future[Any]) -> int:
        """Return how far a piece of work is."""
        place = self._places.get(future)
        return int(self._signs.ticks[place]) if place is not None else 0

    def stop(self, future: Future[Any]) -> None:
        """Call a piece of work off: it is not begun, or ends at its next look."""
        place = self._places.get(future)
        if not future.cancel() and place is not None:
            self._signs.stop[place] = 1

    def kill(self) -> None:
        """End the processes at once."""
        pool = self._pool
        for process in list((getattr(pool, "_processes", None) or {}).values()):
            process.kill()

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:
        """End the processes after the work in hand."""
        if self._pool is not None:
            self._pool.shutdown(wait=wait, cancel_futures=cancel_futures)

    def _start(self) -> ProcessPoolExecutor:
        return pool(self.width, self._niceness, self._signs)

    def _release(self, future: Future[Any], pool: ProcessPoolExecutor) -> None:
        """Take back the signs of a piece of work that has ended, and drop the pool if one of its processes died."""
        self._free.append(self._places.pop(future))
        if not future.cancelled() and isinstance(future.exception(), BrokenProcessPool) and self._pool is pool:
            self._pool = None


def _with_records(folders: list[str], place: int, function: Callable[..., T], *arguments: object) -> T:
    """Call a function that finds the records of the caller; in a worker, which may be older than these folders."""
    record_folders.use(folders)
    return watched(place, function, *arguments)


def pool(workers: int, niceness: int = 0, signs: Signs | None = None) -> ProcessPoolExecutor:
    """Return processes that start quickly: forked from a process that has loaded the code, which takes seconds.

    That one does nothing else; forking this process, which has threads at work, is not safe.
    """
    told = niceness, signs, wall.is_demanded()
    if sys.platform != "linux":
        return ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), prepare, told)
    forkserver.set_forkserver_preload(_preloaded)
    starter = threading.Thread(target=_load, args=(niceness,))
    starter.start()
    starter.join()
    return ProcessPoolExecutor(workers, multiprocessing.get_context("forkserver"), prepare, told)


def preload(module: str) -> None:
    """Load a module in the parent of all processes that start after this."""
    if module not in _preloaded:
        _preloaded.insert(0, module)  # the common data come last, and freeze all loaded objects


def _load(niceness: int) -> None:
    """Start the process that others are forked from; it has the priority of this thread, which is its own on Linux.

    Its priority is reduced half as far as theirs: it has seconds of work, and a user may wait for them.
    """
    os.nice(niceness // 2)
    forkserver.ensure_running()


def prepare(niceness: int = 0, signs: Signs | None = None, behind_wall: bool = False) -> None:
    """Set up a process: its priority, the wall around units, an end with its parent; Ctrl-C is left to the parent."""
    if behind_wall:
        wall.demand()
    if niceness:
        os.nice(max(0, niceness - os.nice(0)))
    if signs is not None:
        receive(signs)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_follow, args=(parent.join,), daemon=True).start()
    importlib.import_module(LOADED)  # where it is not there from the beginning
    collect_seldom()


def collect_seldom() -> None:
    """Let the garbage collector skip the loaded objects, and look for cycles seldom: here almost no object has any."""
    gc.freeze()
    gc.set_threshold(100_000)


def _follow(wait: Callable[[], None]) -> None:
    """End this process after its parent has ended, because a killed parent cannot stop its children."""
    wait()
    os._exit(1)
