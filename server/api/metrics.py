"""Metrics for Prometheus."""

from __future__ import annotations

from fastapi import APIRouter
from fastapi.responses import PlainTextResponse, Response
from prometheus_client import CONTENT_TYPE_LATEST

from server.api.deps import ServiceDep
from server.api.router import name_of

router = APIRouter(tags=["health"], generate_unique_id_function=name_of)


@router.get("/metrics", response_class=PlainTextResponse)
async def metrics(service: ServiceDep) -> Response:
    """Return every metric in Prometheus' text format."""
    service.benches.count()
    return Response(service.metrics.text(), media_type=CONTENT_TYPE_LATEST)
