"""The proxy of a scene: it serves its page and its WebSocket on our port and behind our gate."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from importlib.metadata import version
from pathlib import Path

import msgspec
from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from fastapi.responses import HTMLResponse
from websockets.asyncio.client import ClientConnection, unix_connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.typing import Subprotocol

from server.api.deps import ServiceDep, SocketServiceDep
from server.security.headers import POLICY as POLICY_HEADER
from server.view3d.viewers import Looked

router = APIRouter(include_in_schema=False)
log = logging.getLogger(__name__)

SUBPROTOCOL = Subprotocol(f"viser-v{version('viser')}")
MAX_WATCHERS = 32
LONGEST_LOOK = 64
"""Bytes of a message by which a page looks at a tick."""
CLOSE_VERSION, CLOSE_NO_BENCH, CLOSE_FULL, CLOSE_LOST = 4001, 4404, 1013, 1012


@router.get("/benches/{bench_id}/3d/")
async def get_page(bench_id: str, service: ServiceDep) -> HTMLResponse:
    """Return the page of the 3D view."""
    from server.view3d.page import POLICY, page
    from server.view3d.viewers import device_of

    views = device_of(service.benches.get(bench_id)).views()
    return HTMLResponse(page(views), headers={POLICY_HEADER: POLICY})


@router.websocket("/benches/{bench_id}/3d")
async def join(socket: WebSocket, bench_id: str, service: SocketServiceDep) -> None:
    """Connect a page to the scene of its bench."""
    session = service.benches.find(bench_id)
    show = service.viewers.show_of(session) if session is not None and service.viewers is not None else None
    offered = socket.scope["subprotocols"]
    refusal: tuple[int, str] | None = None
    if SUBPROTOCOL not in offered:
        refusal = (CLOSE_VERSION, f"this server speaks {SUBPROTOCOL}: reload the page")
    elif show is None:
        refusal = (CLOSE_NO_BENCH, "no such bench")
    elif show.watchers >= MAX_WATCHERS:
        refusal = (CLOSE_FULL, "too many watchers")
    await socket.accept(subprotocol=next(iter(offered), None) if refusal else SUBPROTOCOL)
    if refusal or show is None:
        await socket.close(*(refusal or (CLOSE_NO_BENCH, "")))
        return
    looked = Looked()
    hearing = asyncio.create_task(_hear(socket, looked))
    try:
        path = await show.enter()
    except OSError as error:  # a temporary folder that is full, or whose name is too long for a socket
        log.error("the 3D scene of bench %s has no socket: %s", bench_id, error)
        hearing.cancel()
        await socket.close(CLOSE_LOST, "the 3D scene is not reachable")
        return
    try:
        reason = await _relay(socket, path, hearing, looked.first)
        if looked.first.is_set() and not reason and not hearing.done():
            reason = await _relay(socket, await show.open(looked), hearing)
    finally:
        hearing.cancel()
        await show.leave(looked)
    with contextlib.suppress(RuntimeError, WebSocketDisconnect):
        await socket.close(CLOSE_LOST, reason)


async def _relay(socket: WebSocket, path: Path, hearing: asyncio.Task[None], end: asyncio.Event | None = None) -> str:
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
            tasks = [asyncio.create_task(_down(socket, scene))]
            if end is not None:
                tasks.append(asyncio.create_task(_until(end)))
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


async def _until(event: asyncio.Event) -> None:
    """Wait for something to happen."""
    await event.wait()


class Look(msgspec.Struct, tag="look", tag_field="type", forbid_unknown_fields=True):
    """The one message of a page that is heard: it looks at a tick, or at now."""

    tick: int | None


async def _hear(socket: WebSocket, looked: Looked) -> None:
    """Hear at which tick the page looks until it is gone.

    Its other messages are dropped: the scene takes no input, and viser fails on unknown messages.
    """
    while (message := await socket.receive())["type"] != "websocket.disconnect":
        data = message.get("bytes") or b""
        if len(data) <= LONGEST_LOOK:
            with contextlib.suppress(msgspec.MsgspecError):
                looked.look(msgspec.msgpack.decode(data, type=Look).tick)
