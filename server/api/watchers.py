"""Links to watch a bench: people who open one see it live and can change nothing, until the link ends.

A link that was shared may be one: people with the access token open the experiment, all others watch.
"""

from __future__ import annotations

from datetime import datetime, timedelta
from urllib.parse import urlencode

from pydantic import BaseModel, Field

from server.api.bodies import Body
from server.api.deps import IdentityDep, RateLimited, ServiceDep, SessionDep
from server.api.paging import AgePage
from server.api.router import Router
from server.classroom.people import by_arrival
from server.errors import ApiError, not_found
from server.store.base import now

router = Router(prefix="/benches/{bench_id}/watchers", tags=["classes"])

MOST = 20


class NewWatcher(Body):
    """How long a link lasts."""

    hours: float = Field(4.0, gt=0, le=24 * 14, description="Hours until the link ends")
    link: str | None = Field(None, description="Id of a shared link by which people may watch without the token")


class Watcher(BaseModel):
    """A link to watch; its address is shown once."""

    id: str
    until: datetime
    path: str | None = Field(None, description="Path of the address, shown once; the server keeps only a hash")


class WatcherList(BaseModel):
    """The links to watch a bench."""

    watchers: list[Watcher]


@router.post("", status_code=201, dependencies=[RateLimited])
async def make_watcher(body: NewWatcher, session: SessionDep, service: ServiceDep, identity: IdentityDep) -> Watcher:
    """Make a link to watch the bench, or let people watch it by a link that was shared."""
    if len(service.people.watchers(session.id)) >= MOST:
        raise ApiError(409, "limit", f"{MOST} links lead to this bench, the limit", hint="end one first")
    until = now() + timedelta(hours=body.hours)
    given = ""
    if body.link is not None:
        link = await service.links.get(body.link)
        if link.kind != "experiment":
            raise ApiError(422, "invalid", "leads to no experiment", "link")
        given = identity.secret_of_link(link.id)
    person, secret = await service.people.add("watcher", "watcher", until, bench_id=session.id, secret=given)
    service.audit.add("teacher", "watcher", "made a link to watch", session.class_id, session.id)
    return Watcher(
        id=person.id, until=until, path=f"/?{urlencode({'link': body.link})}" if given else f"/watch/{secret}"
    )


@router.get("")
async def list_watchers(session: SessionDep, service: ServiceDep, page: AgePage) -> WatcherList:
    """List the links to watch the bench, oldest first."""
    people = page.cut(service.people.watchers(session.id), by_arrival)
    return WatcherList(watchers=[Watcher(id=one.id, until=one.until or now()) for one in people])


@router.delete("/{watcher_id}", status_code=204, dependencies=[RateLimited])
async def end_watcher(watcher_id: str, session: SessionDep, service: ServiceDep) -> None:
    """End a link to watch; pages that it opened are closed."""
    for person in service.people.watchers(session.id):
        if person.id == watcher_id:
            await service.people.remove(person)
            return service.audit.add("teacher", "watcher", "ended a link to watch", session.class_id, session.id)
    raise not_found("link to watch", watcher_id)
