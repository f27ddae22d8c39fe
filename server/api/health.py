"""Health: whether the process is alive, whether it can serve, and its metrics for Prometheus."""

from __future__ import annotations

from fastapi import APIRouter, Response
from fastapi.responses import PlainTextResponse
from prometheus_client import CONTENT_TYPE_LATEST
from pydantic import BaseModel

from server.api.deps import ServiceDep
from server.api.router import name_of

router = APIRouter(tags=["health"], generate_unique_id_function=name_of)


class Health(BaseModel):
    """Whether all is well, and each part."""

    ok: bool
    checks: dict[str, bool]


@router.get("/health/live", responses={503: {"model": Health}})
async def live(service: ServiceDep, response: Response) -> Health:
    """Answer 200 unless the engine hangs for good; then the server has to be restarted."""
    checks = {"event_loop": True, "engine": not service.watchdog.is_stuck}
    ok = all(checks.values())
    response.status_code = 200 if ok else 503
    return Health(ok=ok, checks=checks)


@router.get("/health/ready", responses={503: {"model": Health}})
async def ready(service: ServiceDep, response: Response) -> Health:
    """Answer 200 when the engine turns, the database can be written and the kernels of a bench are loaded."""
    checks = {
        "started": service.is_ready,
        "engine": service.engine.is_alive and not service.watchdog.barks,
        "watchdog": service.watchdog.is_alive,
        "database": await service.database.is_writable(),
        "kernels": service.kernels.are_loaded,
    }
    ok = all(checks.values())
    response.status_code = 200 if ok else 503
    return Health(ok=ok, checks=checks)


@router.get("/metrics", response_class=PlainTextResponse)
async def metrics(service: ServiceDep) -> Response:
    """Return every metric in Prometheus' text format."""
    service.benches.count()
    return Response(service.metrics.text(), media_type=CONTENT_TYPE_LATEST)
