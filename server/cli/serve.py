"""Serves the application: binds, prints the address to open, runs until it is stopped."""

from __future__ import annotations

import asyncio
import errno
import gc
import logging
import os
import signal
import socket
import sys
import webbrowser
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

import uvicorn

from core.errors import InputError
from server.cli import logs
from server.connection import Connection
from server.security.identity import fits_header
from server.security.privacy import keep_private
from server.settings import ANY_IPV4, ANY_IPV6, Settings
from server.store.lock import lock
from server.stream.line import WebSocketLine

if TYPE_CHECKING:
    from fastapi import FastAPI

    from server.service import Service

log = logging.getLogger(__name__)

LOOPBACK = "127.0.0.1"
SWITCH_S = 0.001
"""How long a thread keeps the interpreter while another waits: a round of the engine has 8 ms for all benches."""
MIN_TOKEN = 16
GRACE_S = 6
REFUSED = {
    errno.EADDRINUSE: ("port", "another program listens there; stop it, or choose another --port: 0 takes a free one"),
    errno.EADDRNOTAVAIL: ("host", "this machine has no such address"),
    errno.EACCES: ("port", "only the administrator may take it; choose another --port"),
}
"""The setting to blame for an error of the system, and the way out."""


class Server(uvicorn.Server):
    """A uvicorn server that tells pages that it stops before it closes their sockets.

    Parameters
    ----------
    config : uvicorn.Config
        As for uvicorn.
    service : Service
        The service whose streams are closed.
    address : str
        Printed once requests are answered.
    notice : str
        Lines printed below it.
    """

    def __init__(self, config: uvicorn.Config, service: Service, address: str = "", notice: str = "") -> None:
        super().__init__(config)
        self._service, self._address, self._notice = service, address, notice

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start, then print the address."""
        await super().startup(sockets)
        if self.started and self._address:
            # All objects loaded by now stay. A collection that went through them would stop all benches for 0.1 s.
            gc.freeze()
            gc.enable()
            sys.setswitchinterval(SWITCH_S)
            try:
                sys.stdout.write(f"CombBench is at {self._address}\n{self._notice}")
                sys.stdout.flush()
            except OSError as error:  # the service runs even if a full disk takes no output
                log.warning("the address to open cannot be printed: %s", error.strerror)
            if self._service.settings.open_page:
                await asyncio.to_thread(webbrowser.open, self._address)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Tell the pages that the server stops, then close."""
        await self._service.close_streams()
        await super().shutdown(sockets)


def check_binding(settings: Settings) -> None:
    """Refuse an address that other machines can reach without a token from the settings, except for a class.

    Raises
    ------
    InputError
        With the necessary setting.
    """
    token = settings.token.get_secret_value() if settings.token else ""
    if token and len(token) < MIN_TOKEN:
        raise InputError(f"must have at least {MIN_TOKEN} characters", "token")
    if not fits_header(token):
        text = "cannot be sent in a header; allowed: letters without accents, digits and signs, no space at either end"
        raise InputError(text, "token", "set COMBBENCH_TOKEN to another")
    if settings.classroom and settings.public_origin:
        raise InputError(
            "cannot be used with public_origin: a proxy makes everyone look like this machine, which may use the token",
            "classroom",
            "serve the class through the proxy without it, as docs/behind-a-proxy.md says, or unset public_origin",
        )
    if settings.classroom and settings.is_loopback:
        text = f"students cannot reach {settings.host}, which is this machine alone"
        raise InputError(text, "classroom", f"leave host out, or set it to {ANY_IPV4} or an address of this machine")
    if not settings.is_loopback and not settings.classroom and not token:
        raise InputError(
            f"{settings.host} can be reached from other machines, which needs an access token",
            "host",
            f"set COMBBENCH_TOKEN to {MIN_TOKEN} characters or more, or listen on 127.0.0.1",
        )


def bind(settings: Settings) -> socket.socket:
    """Open the listening socket.

    Raises
    ------
    InputError
        If the address cannot be bound.
    """
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    # A frame waits in the one slot of its client, because in a buffer of the kernel it would grow old.
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 256 << 10)
    try:
        listener.bind((settings.host, settings.port))
        listener.listen(1024)
    except OSError as error:
        listener.close()
        field, hint = REFUSED.get(error.errno or 0, ("port", ""))
        text = f"cannot listen on {settings.host}:{settings.port}: {error.strerror or error}"
        raise InputError(text, field, hint) from None
    return listener


def unusable(data: Path, error: OSError) -> InputError:
    """Return the error of a start that cannot use the data folder, or another file such as one in shared memory."""
    file = Path(os.fsdecode(error.filename or data)).absolute()
    if not file.is_relative_to(data):
        return InputError(f"{file} cannot be used: {error.strerror}")
    return InputError(f"the data folder {data} cannot be used: {error.strerror}", "data", "choose another --data")


def make_server(settings: Settings, app: FastAPI, address: str = "", notice: str = "") -> Server:
    """Configure uvicorn: one process owns the boards, so there is one worker."""
    config = uvicorn.Config(
        app,
        loop="uvloop",
        http=Connection,
        ws=WebSocketLine,
        ws_max_size=settings.message_limit_bytes,
        ws_per_message_deflate=False,
        ws_ping_interval=20.0,
        ws_ping_timeout=20.0,
        limit_concurrency=settings.max_clients + 256,
        timeout_graceful_shutdown=GRACE_S,
        timeout_keep_alive=30,
        server_header=False,
        access_log=False,
        log_config=None,
        proxy_headers=False,
    )
    return Server(config, app.state.service, address, notice)


def serve(settings: Settings) -> None:
    """Serve until SIGINT or SIGTERM.

    Raises
    ------
    InputError
        If the settings do not allow it; the caller says so and exits with 2.
    """
    check_binding(settings)
    logs.configure(settings)
    with ExitStack() as stack:
        listeners = [stack.enter_context(bind(settings))]
        port = listeners[0].getsockname()[1]
        is_everywhere = settings.host in (ANY_IPV4, ANY_IPV6)
        if settings.classroom and not is_everywhere:  # the teacher comes by an address of this machine alone
            listeners.append(stack.enter_context(bind(settings.model_copy(update={"host": LOOPBACK, "port": port}))))
        try:
            keep_private(settings.data)
            stack.enter_context(lock(settings.data, "data"))
            if settings.database_url:
                from server.store.database import FILE, check_left_behind

                check_left_behind(settings.data / FILE)
            gc.disable()  # loading makes many objects and no garbage; `startup` turns it on again
            from server.app import create_app  # this import loads everything; wrong settings are reported before it

            app = create_app(settings)
            app.state.service.database.migrate()
            app.state.service.database.claim()
        except OSError as error:
            raise unusable(settings.data.absolute(), error) from None
        host = f"[{settings.host}]" if ":" in settings.host else settings.host
        shown = LOOPBACK if settings.classroom or is_everywhere else host
        page = settings.public_origin or f"http://{shown}:{port}"
        address = f"{page}/?token={quote(app.state.identity.token, safe='')}"
        notice = ""
        if settings.classroom:
            from server.classroom import addresses

            notice = addresses.notice(settings, port)
        server = make_server(settings, app, address, notice)
        # uvicorn raises the signal again at its end; a stop by signal is no failure.
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: None)
        server.run(sockets=listeners)
    if not server.started:
        raise InputError("the service did not start; the lines above say why", "serve")
