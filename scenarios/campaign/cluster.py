"""A Dask cluster that computes a campaign."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from functools import partial
from typing import Any, TypeVar

from core.errors import InputError
from core.wall import wall
from scenarios.extras import require

T = TypeVar("T")

CONNECT_S = 5.0


class Cluster(Executor):
    """Hands work over to a cluster, and returns an answer for every piece of it.

    Dask's own executor never answers for a piece that was done but could not be fetched, for example if the scheduler
    is lost at that moment: a caller would wait for it without end.

    Parameters
    ----------
    client : distributed.Client
        Connected to the scheduler.
    """

    def __init__(self, client: Any) -> None:
        self._client = client

    @property
    def width(self) -> int:
        """Number of pieces computed at once: the threads of all workers, or 1 while there is no worker.

        Raises
        ------
        OSError
            When the scheduler is gone.
        """
        try:
            return max(1, int(sum(self._client.nthreads().values())))
        except AttributeError as error:  # a client that lost its scheduler cannot ask it
            raise ConnectionError(f"the client of the scheduler is {self._client.status}") from error

    def stop(self, task: Future[Any]) -> None:
        """Call a piece of work off; a worker that has begun it finishes it, and its result is dropped."""
        task.cancel()

    def submit(self, function: Callable[..., T], /, *arguments: Any, **named: Any) -> Future[T]:
        """Hand over a piece of work.

        Raises
        ------
        OSError
            When the scheduler is gone.
        """
        from distributed.client import ClosedClientError

        try:
            told = partial(behind_wall, function) if wall.is_demanded() else function
            task = self._client.submit(told, *arguments, **named, pure=False)
        except ClosedClientError as error:
            raise ConnectionError(str(error)) from error
        answer: Future[T] = Future()
        answer.add_done_callback(lambda future: task.cancel() if future.cancelled() else None)

        async def bring() -> None:
            try:
                result, error = await task, None
            except Exception as reason:
                result, error = None, reason
            if not answer.set_running_or_notify_cancel():
                return
            if error is None:
                answer.set_result(result)
            else:
                answer.set_exception(error)

        self._client.loop.add_callback(bring)
        return answer


def behind_wall(function: Callable[..., T], *arguments: Any, **named: Any) -> T:
    """Do a piece of work for a server on which units run behind the wall; the worker keeps to it from then on."""
    wall.demand()
    return function(*arguments, **named)


def check_address(address: str) -> None:
    """Refuse a text that is not an address; a client that is given one refuses it too, but leaves threads behind.

    Raises
    ------
    InputError
        If it is not an address, or if the certificates for it are missing.
    """
    require("distributed", "cluster", "--scheduler")
    from dask import config
    from distributed.comm.addressing import get_address_host_port

    try:
        _, port = get_address_host_port(address)
        if not 0 < port < 65536:
            raise ValueError(f"there is no port {port}")
    except ValueError as error:
        raise InputError(f"is no address of a scheduler: {error}", "--scheduler") from None
    if address.startswith("tls://") and not config.get("distributed.comm.tls.ca-file", None):
        text = "needs certificates: DASK_DISTRIBUTED__COMM__TLS__CA_FILE, __CLIENT__CERT and __CLIENT__KEY are not set"
        raise InputError(text, "--scheduler", "docs/scaling.md says how they are made")


@contextmanager
def open_cluster(address: str) -> Iterator[Cluster]:
    """Connect to the scheduler at an address.

    Raises
    ------
    OSError
        When it does not answer.
    InputError
        If it is not an address.
    """
    from distributed import Client

    check_address(address)
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # the futures report lost work
    client = Client(address, timeout=CONNECT_S, set_as_default=False)
    try:
        yield Cluster(client)
    finally:
        client.close(timeout=CONNECT_S)
