"""Where the runs of a campaign are computed: processes of this machine, or a Dask cluster by its address."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager

from core.errors import InputError

CONNECT_S = 5.0
LOST: tuple[type[BaseException], ...] = (BrokenProcessPool, CancelledError, OSError)
"""What a future or a connection says when a worker, the scheduler or the line to it is gone."""


@contextmanager
def open_executor(workers: int, scheduler: str = "", niceness: int = 0) -> Iterator[Executor]:
    """Open processes of this machine, or a cluster when there is an address.

    Raises
    ------
    OSError
        When the cluster does not answer.
    """
    if scheduler:
        with _cluster(scheduler) as executor:
            yield executor
        return
    # Spawned, because forking a process with threads is not safe.
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(workers, context, prepare, (niceness,))
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


@contextmanager
def _cluster(address: str) -> Iterator[Executor]:
    from distributed import Client

    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what is lost is told by the futures
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
    except ValueError as error:
        raise InputError(f"is no address of a scheduler: {error}", "--scheduler") from None
    try:
        executor = client.get_executor(pure=False)
        yield executor
        executor.shutdown(wait=False)
    finally:
        client.close(timeout=CONNECT_S)


def prepare(niceness: int = 0) -> None:
    """Make a process ready: one thread, at some priority, gone when its parent is; Ctrl-C is left to the parent."""
    if niceness:
        os.nice(niceness)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_follow, args=(parent.join,), daemon=True).start()
    import scenarios.run  # noqa: F401  (load the kernels before the first run)


def _follow(wait: Callable[[], None]) -> None:
    """End this process when another has ended; one that was killed tells nobody."""
    wait()
    os._exit(1)
