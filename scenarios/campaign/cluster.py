"""A Dask cluster as the place where a campaign is computed."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from typing import Any, TypeVar

from core.errors import InputError

T = TypeVar("T")

CONNECT_S = 5.0


class Cluster(Executor):
    """Hands work over to a cluster, and answers for every piece of it.

    The executor that comes with Dask never answers for a piece that was done but could not be fetched, as when the
    scheduler goes at that moment; whoever waits for it waits for ever.

    Parameters
    ----------
    client : distributed.Client
        Connected to the scheduler.
    """

    def __init__(self, client: Any) -> None:
        self._client = client

    @property
    def width(self) -> int:
        """How many pieces are computed at once: the threads of all workers, 1 while there is none.

        Raises
        ------
        OSError
            When the scheduler is gone.
        """
        try:
            return max(1, int(sum(self._client.nthreads().values())))
        except AttributeError as error:  # a client that lost its scheduler has none to ask
            raise ConnectionError(f"the client of the scheduler is {self._client.status}") from error

    def submit(self, function: Callable[..., T], /, *arguments: Any, **named: Any) -> Future[T]:
        """Hand over a piece of work.

        Raises
        ------
        OSError
            When the scheduler is gone.
        """
        from distributed.client import ClosedClientError

        try:
            task = self._client.submit(function, *arguments, **named, pure=False)
        except ClosedClientError as error:
            raise ConnectionError(str(error)) from error
        answer: Future[T] = Future()
        answer.add_done_callback(lambda future: task.cancel() if future.cancelled() else None)

        async def bring() -> None:
            try:
                found, error = await task, None
            except Exception as reason:
                found, error = None, reason
            if not answer.set_running_or_notify_cancel():
                return
            if error is None:
                answer.set_result(found)
            else:
                answer.set_exception(error)

        self._client.loop.add_callback(bring)
        return answer


def check_address(address: str) -> None:
    """Refuse what is no address; a client that is given one does not only refuse it, it leaves half of itself behind.

    Raises
    ------
    InputError
        When it is none.
    """
    from distributed.comm.addressing import get_address_host_port

    try:
        _, port = get_address_host_port(address)
        if not 0 < port < 65536:
            raise ValueError(f"there is no port {port}")
    except ValueError as error:
        raise InputError(f"is no address of a scheduler: {error}", "--scheduler") from None


@contextmanager
def open_cluster(address: str) -> Iterator[Cluster]:
    """Connect to the scheduler at an address.

    Raises
    ------
    OSError
        When it does not answer.
    InputError
        When it is no address.
    """
    from distributed import Client

    check_address(address)
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what is lost is told by the futures
    client = Client(address, timeout=CONNECT_S, set_as_default=False)
    try:
        yield Cluster(client)
    finally:
        client.close(timeout=CONNECT_S)
