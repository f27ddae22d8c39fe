"""The actions of users, in a class or on a bench."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel

from server.api.deps import ServiceDep
from server.api.paging import Number, pages
from server.api.router import Router
from server.classroom.audit import AuditEntry
from server.paging import ListPage

router = Router(tags=["classes"])

AuditPage = Annotated[ListPage, pages(Number, usual=1000)]


class AuditList(BaseModel):
    """The actions of users, newest first."""

    entries: list[AuditEntry]


@router.get("/classes/{class_id}/audit")
async def get_class_audit(class_id: str, service: ServiceDep, page: AuditPage) -> AuditList:
    """List the actions of users in a class, newest first."""
    await service.classes.row(class_id)
    return AuditList(entries=await service.audit.entries(class_id=class_id, page=page))


@router.get("/benches/{bench_id}/audit")
async def get_bench_audit(bench_id: str, service: ServiceDep, page: AuditPage) -> AuditList:
    """List the actions of users on a bench, newest first, also on a deleted bench."""
    return AuditList(entries=await service.audit.entries(bench_id=bench_id, page=page))
