"""Executors of the runs of a campaign: processes of this machine, or a Dask cluster by its address."""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager

from scenarios.campaign.cluster import Cluster, open_cluster

LOST: tuple[type[BaseException], ...] = (BrokenProcessPool, CancelledError, OSError)
"""Errors of a future or a connection after a worker, the scheduler or the line to it is lost."""


@contextmanager
def open_executor(workers: int, scheduler: str = "", niceness: int = 0) -> Iterator[Executor]:
    """Open processes of this machine, or a cluster when there is an address.

    Raises
    ------
    OSError
        When the cluster does not answer.
    """
    if scheduler:
        with open_cluster(scheduler) as executor:
            yield executor
        return
    # Spawned, because forking a process with threads is not safe.
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(workers, context, prepare, (niceness,))
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def width_of(executor: Executor, workers: int) -> int:
    """Return the number of batches computed at once: the threads of a cluster, or the processes of the pool.

    Raises
    ------
    OSError
        When the scheduler is gone.
    """
    return executor.width if isinstance(executor, Cluster) else workers


def prepare(niceness: int = 0) -> None:
    """Set up a process: one thread, its priority, an end with its parent; Ctrl-C is left to the parent."""
    if niceness:
        os.nice(niceness)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_follow, args=(parent.join,), daemon=True).start()
    import scenarios.campaign.batch  # noqa: F401  (load the kernels before the first run)

    gc.freeze()  # what is loaded stays: no collection looks at it again


def _follow(wait: Callable[[], None]) -> None:
    """End this process after its parent has ended: a parent that was killed cannot tell its children."""
    wait()
    os._exit(1)
