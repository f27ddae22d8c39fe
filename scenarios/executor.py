"""Where the runs of a campaign are computed: processes of this machine, or a Dask cluster by its address."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any, TypeVar

from core.errors import InputError

T = TypeVar("T")

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


def width_of(executor: Executor, workers: int) -> int:
    """Return how many batches are computed at once: the threads of a cluster, or the processes of the pool.

    Raises
    ------
    OSError
        When the scheduler is gone.
    """
    client = getattr(executor, "_client", None)
    if client is None:
        return workers
    try:
        return max(1, int(sum(client.nthreads().values())))
    except AttributeError as error:  # a client that lost its scheduler has none to ask
        raise ConnectionError(f"the client of the scheduler is {client.status}") from error


def submit(executor: Executor, function: Callable[..., T], *arguments: Any) -> Future[T]:
    """Hand over a piece of work.

    Raises
    ------
    OSError
        When the scheduler is gone.
    """
    try:
        return executor.submit(function, *arguments)
    except Exception as error:
        if type(error).__name__ == "ClosedClientError":  # of a package that is loaded only for a cluster
            raise ConnectionError(str(error)) from error
        raise


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
