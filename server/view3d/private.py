"""A viser server on a socket that only this user can open.

Without this, viser listens on a TCP port that every user of the machine and every page in their browsers can open.
"""

from __future__ import annotations

import socket
import tempfile
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import rich
import viser
import websockets.asyncio.server
from viser.infra import _infra


class PrivateServer:
    """A viser server on a Unix socket in a folder of its own, which only this user may enter.

    It serves WebSockets alone, and only to clients that connect by :attr:`path`.
    """

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="combbench-3d-")  # for the owner alone
        self.path = Path(self._folder.name) / "scene"
        listener = socket.socket(socket.AF_UNIX)
        try:
            listener.bind(str(self.path))
            self.viser = viser.ViserServer(host=cast(str, listener), verbose=False)
        except BaseException:
            listener.close()
            self._folder.cleanup()
            raise

    def stop(self) -> None:
        """Stop the server and disconnect its clients."""
        self.viser.stop()
        self._folder.cleanup()


def _serve(handler: Any, listener: Any, _port: int, **options: Any) -> Any:
    """Open viser's server with a socket as its host; our own page serves its files."""
    return websockets.asyncio.server.unix_serve(handler, sock=listener, **{**options, "process_request": None})


def _use_sockets() -> None:
    """Let viser, which takes only hosts and ports, serve on the given socket."""
    ours = SimpleNamespace(**{**vars(websockets.asyncio.server), "serve": _serve})
    whole = SimpleNamespace(**{**vars(websockets), "asyncio": SimpleNamespace(server=ours)})
    vars(_infra)["websockets"] = whole


rich.get_console().quiet = True  # viser prints to standard output in spite of its settings
_use_sockets()
