"""Passes the messages of a scene to a page, and notes the tick that the page looks at."""

from __future__ import annotations

import asyncio
import contextlib
from importlib.metadata import version
from pathlib import Path

import msgspec
from fastapi import WebSocket, WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, unix_connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.typing import Subprotocol

from server.view3d.viewers import Looked

SUBPROTOCOL = Subprotocol(f"viser-v{version('viser')}")
LONGEST_LOOK = 64
"""Bytes of a message by which a page looks at a tick."""


async def relay(socket: WebSocket, path: Path, hearing: asyncio.Task[None], end: asyncio.Event | None = None) -> str:
    """Show a scene to the page until either side ends, or an event ends it; return the error."""
    try:
        async with unix_connect(
            str(path),
            "ws://localhost/",
            subprotocols=[SUBPROTOCOL],
            compression=None,
            max_size=None,
            ping_interval=None,
        ) as scene:
            tasks: list[asyncio.Task[object]] = [asyncio.create_task(_down(socket, scene))]
            if end is not None:
                tasks.append(asyncio.create_task(end.wait()))
            try:
                await asyncio.wait([*tasks, hearing], return_when=asyncio.FIRST_COMPLETED)
            finally:
                for task in tasks:
                    task.cancel()
                await asyncio.gather(*tasks, return_exceptions=True)
    except (OSError, InvalidHandshake):
        return "the 3D scene is not reachable"
    return ""


async def _down(socket: WebSocket, scene: ClientConnection) -> None:
    """Pass messages from the scene to the page."""
    with contextlib.suppress(ConnectionClosed, WebSocketDisconnect, RuntimeError):
        async for message in scene:
            if isinstance(message, bytes):
                await socket.send_bytes(message)


class LookMessage(msgspec.Struct, tag="look", tag_field="type", forbid_unknown_fields=True):
    """The one message of a page that is read: the tick it looks at, or null for now."""

    tick: int | None


async def hear(socket: WebSocket, looked: Looked) -> None:
    """Note at which tick the page looks, until it is gone.

    Its other messages are dropped: the scene takes no input, and viser fails on unknown messages.
    """
    while (message := await socket.receive())["type"] != "websocket.disconnect":
        data = message.get("bytes") or b""
        if len(data) <= LONGEST_LOOK:
            with contextlib.suppress(msgspec.MsgspecError):
                looked.look(msgspec.msgpack.decode(data, type=LookMessage).tick)
