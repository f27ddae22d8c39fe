"""The way to a scene: its page and its WebSocket, on our port and behind our gate."""

from __future__ import annotations

import asyncio
import contextlib

from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from fastapi.responses import HTMLResponse
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.typing import Subprotocol

from server.api.deps import ServiceDep, SocketServiceDep
from server.security.headers import POLICY as POLICY_HEADER

router = APIRouter(include_in_schema=False)

MAX_WATCHERS = 32
CLOSE_NO_BENCH, CLOSE_FULL, CLOSE_LOST = 4404, 1013, 1012


@router.get("/benches/{bench_id}/3d/")
async def get_page(bench_id: str, service: ServiceDep) -> HTMLResponse:
    """Return the page of the 3D view."""
    from server.view3d.page import POLICY, page
    from server.view3d.theatre import layout_of

    layout = layout_of(service.benches.get(bench_id))
    return HTMLResponse(page(layout), headers={POLICY_HEADER: POLICY})


@router.websocket("/benches/{bench_id}/3d")
async def join(socket: WebSocket, bench_id: str, service: SocketServiceDep) -> None:
    """Connect a page to the scene of its bench."""
    session = service.benches.find(bench_id)
    show = service.theatre.show_of(session) if session is not None and service.theatre is not None else None
    if show is None or show.watchers >= MAX_WATCHERS:
        await socket.accept(subprotocol=next(iter(socket.scope["subprotocols"]), None))
        code, reason = (CLOSE_NO_BENCH, "no such bench") if show is None else (CLOSE_FULL, "too many watchers")
        await socket.close(code, reason)
        return
    port = await show.enter()
    try:
        await _relay(socket, port)
    finally:
        await show.leave()


async def _relay(socket: WebSocket, port: int) -> None:
    """Pass messages both ways until either side ends."""
    offered = [Subprotocol(name) for name in socket.scope["subprotocols"]]
    try:
        # proxy=None: with a proxy in the environment even 127.0.0.1 would go to it.
        upstream = await connect(
            f"ws://127.0.0.1:{port}/",
            subprotocols=offered or None,
            compression=None,
            max_size=None,
            ping_interval=None,
            proxy=None,
        )
    except (OSError, InvalidHandshake):
        await socket.accept(subprotocol=next(iter(offered), None))
        await socket.close(CLOSE_LOST, "the 3D scene is not reachable")
        return
    async with upstream:
        await socket.accept(subprotocol=upstream.subprotocol)
        tasks = [asyncio.create_task(_down(socket, upstream)), asyncio.create_task(_up(socket, upstream))]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        with contextlib.suppress(RuntimeError, WebSocketDisconnect):
            await socket.close(CLOSE_LOST)


async def _down(socket: WebSocket, upstream: ClientConnection) -> None:
    """From the scene to the page."""
    with contextlib.suppress(ConnectionClosed, WebSocketDisconnect, RuntimeError):
        async for message in upstream:
            if isinstance(message, str):
                await socket.send_text(message)
            else:
                await socket.send_bytes(message)


async def _up(socket: WebSocket, upstream: ClientConnection) -> None:
    """From the page to the scene."""
    with contextlib.suppress(ConnectionClosed):
        while True:
            message = await socket.receive()
            if message["type"] == "websocket.disconnect":
                return
            data = message.get("bytes")
            await upstream.send(data if data is not None else message.get("text") or "")
