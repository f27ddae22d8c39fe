"""The actions of users, in a class or on a bench."""

from __future__ import annotations

from typing import Annotated

from fastapi import Query
from pydantic import BaseModel

from server.api.deps import ServiceDep
from server.api.router import Router
from server.classroom.audit import AuditEntry

router = Router(tags=["classes"])

Limit = Annotated[int, Query(ge=1, le=10_000)]


class AuditList(BaseModel):
    """The actions of users, newest first."""

    entries: list[AuditEntry]


@router.get("/classes/{class_id}/audit")
async def get_class_audit(class_id: str, service: ServiceDep, limit: Limit = 1000) -> AuditList:
    """List the actions of users in a class."""
    await service.classes.row(class_id)
    return AuditList(entries=await service.audit.entries(class_id=class_id, limit=limit))


@router.get("/benches/{bench_id}/audit")
async def get_bench_audit(bench_id: str, service: ServiceDep, limit: Limit = 1000) -> AuditList:
    """List the actions of users on a bench, also on a deleted bench."""
    return AuditList(entries=await service.audit.entries(bench_id=bench_id, limit=limit))
