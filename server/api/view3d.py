"""The 3D view of a bench: its page and its WebSocket, on our port and behind our gate."""

from __future__ import annotations

import asyncio
import contextlib
import logging

from fastapi import APIRouter, WebSocket, WebSocketDisconnect
from fastapi.responses import HTMLResponse

from server.api.deps import ServiceDep
from server.security.headers import POLICY as POLICY_HEADER
from server.view3d.relay import SUBPROTOCOL, hear, relay
from server.view3d.viewers import Looked

router = APIRouter(include_in_schema=False)
log = logging.getLogger(__name__)

MAX_WATCHERS = 32
CLOSE_VERSION, CLOSE_NO_BENCH, CLOSE_FULL, CLOSE_LOST = 4001, 4404, 1013, 1012


@router.get("/benches/{bench_id}/3d/")
async def get_page(bench_id: str, service: ServiceDep) -> HTMLResponse:
    """Return the page of the 3D view."""
    from server.view3d.page import POLICY, page
    from server.view3d.viewers import device_of

    views = device_of(service.benches.get(bench_id)).views()
    return HTMLResponse(page(views), headers={POLICY_HEADER: POLICY})


@router.websocket("/benches/{bench_id}/3d")
async def join(socket: WebSocket, bench_id: str, service: ServiceDep) -> None:
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
    hearing = asyncio.create_task(hear(socket, looked))
    try:
        path = await show.enter()
    except OSError as error:  # a temporary folder that is full, or whose name is too long for a socket
        log.error("the 3D scene of bench %s has no socket: %s", bench_id, error)
        hearing.cancel()
        await socket.close(CLOSE_LOST, "the 3D scene is not reachable")
        return
    try:
        reason = await relay(socket, path, hearing, looked.first)
        if looked.first.is_set() and not reason and not hearing.done():
            reason = await relay(socket, await show.open(looked), hearing)
    finally:
        hearing.cancel()
        await show.leave(looked)
    with contextlib.suppress(RuntimeError, WebSocketDisconnect):
        await socket.close(CLOSE_LOST, reason)
