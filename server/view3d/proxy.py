"""The proxy of a scene: it serves its page and its WebSocket on our port and behind our gate."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from importlib.metadata import version
from pathlib import Path

from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from fastapi.responses import HTMLResponse
from websockets.asyncio.client import ClientConnection, unix_connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.typing import Subprotocol

from server.api.deps import ServiceDep, SocketServiceDep
from server.security.headers import POLICY as POLICY_HEADER

router = APIRouter(include_in_schema=False)
log = logging.getLogger(__name__)

SUBPROTOCOL = Subprotocol(f"viser-v{version('viser')}")
MAX_WATCHERS = 32
CLOSE_VERSION, CLOSE_NO_BENCH, CLOSE_FULL, CLOSE_LOST = 4001, 4404, 1013, 1012


@router.get("/benches/{bench_id}/3d/")
async def get_page(bench_id: str, service: ServiceDep) -> HTMLResponse:
    """Return the page of the 3D view."""
    from server.view3d.page import POLICY, page
    from server.view3d.viewers import layout_of

    layout = layout_of(service.benches.get(bench_id))
    return HTMLResponse(page(layout), headers={POLICY_HEADER: POLICY})


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
    try:
        path = await show.enter()
    except OSError as error:  # a temporary folder that is full, or whose name is too long for a socket
        log.error("the 3D scene of bench %s has no socket: %s", bench_id, error)
        await socket.close(CLOSE_LOST, "the 3D scene is not reachable")
        return
    try:
        await _relay(socket, path)
    finally:
        await show.leave()


async def _relay(socket: WebSocket, path: Path) -> None:
    """Show the scene to the page until either side ends."""
    reason = ""
    try:
        async with unix_connect(
            str(path),
            "ws://localhost/",
            subprotocols=[SUBPROTOCOL],
            compression=None,
            max_size=None,
            ping_interval=None,
        ) as scene:
            tasks = [asyncio.create_task(_down(socket, scene)), asyncio.create_task(_until_gone(socket))]
            try:
                await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            finally:
                for task in tasks:
                    task.cancel()
                await asyncio.gather(*tasks, return_exceptions=True)
    except (OSError, InvalidHandshake):
        reason = "the 3D scene is not reachable"
    with contextlib.suppress(RuntimeError, WebSocketDisconnect):
        await socket.close(CLOSE_LOST, reason)


async def _down(socket: WebSocket, scene: ClientConnection) -> None:
    """Pass messages from the scene to the page."""
    with contextlib.suppress(ConnectionClosed, WebSocketDisconnect, RuntimeError):
        async for message in scene:
            if isinstance(message, bytes):
                await socket.send_bytes(message)


async def _until_gone(socket: WebSocket) -> None:
    """Drop the messages of the page: the scene takes no input, and viser fails on unknown messages."""
    while (await socket.receive())["type"] != "websocket.disconnect":
        pass
