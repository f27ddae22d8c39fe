"""Snapshots: moments of a bench that can be gone back to."""

from __future__ import annotations

from pydantic import BaseModel, Field

from server.api.bodies import Body
from server.api.deps import CallerDep, PersonDep, RateLimited, ServiceDep, SessionDep
from server.api.paging import AgePage
from server.api.router import Router
from server.bench.status import Bench, Snapshot
from server.paging import by_age

router = Router(prefix="/benches/{bench_id}/snapshots", tags=["snapshots"])


class NewSnapshot(Body):
    """The name of this moment."""

    name: str = Field("", max_length=100)


class SnapshotList(BaseModel):
    """The moments kept, oldest first."""

    snapshots: list[Snapshot]


@router.post("", status_code=201, dependencies=[RateLimited])
async def take_snapshot(
    session: SessionDep, service: ServiceDep, caller: CallerDep, body: NewSnapshot | None = None
) -> Snapshot:
    """Keep this moment."""
    name = body.name if body else ""
    return await service.engine.call(session.snapshots.take, name, caller, service.settings.max_snapshots)


@router.get("")
async def list_snapshots(session: SessionDep, page: AgePage) -> SnapshotList:
    """List the moments kept, oldest first."""
    return SnapshotList(snapshots=page.cut(session.snapshots.all(), by_age))


@router.delete("/{snapshot_id}", status_code=204, dependencies=[RateLimited])
async def delete_snapshot(snapshot_id: str, session: SessionDep, service: ServiceDep) -> None:
    """Forget a moment."""
    await service.engine.call(session.snapshots.forget, snapshot_id)


@router.post("/{snapshot_id}/restore", dependencies=[RateLimited])
async def restore_snapshot(
    snapshot_id: str, session: SessionDep, service: ServiceDep, person: PersonDep, caller: CallerDep
) -> Bench:
    """Go back to a moment; from there the bench computes the same bits again."""
    await service.engine.call(session.snapshots.restore, snapshot_id, caller)
    return service.views.of(session, person)
