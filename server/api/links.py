"""Links: an experiment or a layout of the page by a permanent short id."""

from __future__ import annotations

import asyncio
from typing import Literal

from fastapi import Response
from pydantic import BaseModel, Field

from server.api.bodies import Body, ScenarioDocument
from server.api.deps import IdentityDep, PersonDep, RateLimited, ServiceDep
from server.api.paging import AgePage
from server.api.router import Router
from server.bench.build import prepare
from server.bench.description import beginning_of, experiment_of
from server.bench.pacing import usual_scale
from server.bench.recording import Layout
from server.bench.status import Bench
from server.errors import ApiError
from server.store.links import Content, Link, LinkDetail

router = Router(prefix="/links", tags=["links"])

LONGEST_TITLE, LONGEST_NOTE = 200, 2000


class NewLink(Body):
    """The target of a link: a bench as it is now, a scenario, or a layout of the page alone."""

    bench: str | None = Field(None, description="Id of a live bench, whose commands are kept")
    scenario: str | ScenarioDocument | None = Field(None, description="Library id, TOML text, or document")
    layout: Layout = Field(None, description="Layout of the page, with its cursors")
    title: str = Field("", max_length=LONGEST_TITLE, description="Title of the link; empty: the title of the scenario")
    note: str = Field("", max_length=LONGEST_NOTE, description="Note for readers")


class Words(Body):
    """The editable fields of a link."""

    title: str | None = Field(None, min_length=1, max_length=LONGEST_TITLE, description="Null: as before")
    note: str | None = Field(None, max_length=LONGEST_NOTE, description="Null: as before")


class LinkList(BaseModel):
    """Links, newest first."""

    links: list[Link]


@router.post("", status_code=201, dependencies=[RateLimited])
async def make_link(body: NewLink, service: ServiceDep, person: PersonDep, response: Response) -> LinkDetail:
    """Keep an experiment or a layout; it stays when the bench goes."""
    if body.bench is not None and body.scenario is not None:
        raise ApiError(422, "invalid", "give a bench or a scenario, not both", "scenario")
    if body.bench is None and body.scenario is None and body.layout is None:
        raise ApiError(422, "invalid", "needs a bench, a scenario or a layout", "bench")
    await service.keeping.room()
    experiment, title = None, body.title
    if body.bench is not None:
        session = service.views.whole(body.bench, person)
        experiment = await service.engine.call(experiment_of, session)
        title = title or session.scenario.head.title or session.scenario.id
    elif body.scenario is not None:
        await service.benches.check(body.scenario, {})
        scenario, board = await asyncio.to_thread(prepare, body.scenario, {}, None)
        experiment = beginning_of(scenario, board, usual_scale(board))
        title = title or scenario.head.title or scenario.id
    content = Content(experiment=experiment, layout=body.layout)
    link = await service.links.keep(content, title[:LONGEST_TITLE] or "Layout", body.note)
    response.headers["Location"] = f"/api/v1/links/{link.id}"
    return link


@router.get("")
async def list_links(
    service: ServiceDep, page: AgePage, kind: Literal["experiment", "layout"] | None = None
) -> LinkList:
    """List the links, newest first."""
    return LinkList(links=await service.links.all(kind, page))


@router.get("/{link_id}")
async def get_link(link_id: str, service: ServiceDep) -> LinkDetail:
    """Return a link and its target."""
    return await service.links.get(link_id)


@router.patch("/{link_id}", dependencies=[RateLimited])
async def change_link(link_id: str, body: Words, service: ServiceDep) -> LinkDetail:
    """Change the title or the note of a link."""
    return await service.links.change(link_id, **body.model_dump(exclude_none=True))


@router.delete("/{link_id}", status_code=204, dependencies=[RateLimited])
async def delete_link(link_id: str, service: ServiceDep, identity: IdentityDep) -> None:
    """Delete a link; benches that it opened stay, and persons who watch by it are disconnected."""
    await service.links.get(link_id)
    await service.people.close(identity.secret_of_link(link_id))
    await service.links.delete(link_id)


@router.post("/{link_id}/open", status_code=201, dependencies=[RateLimited])
async def open_link(link_id: str, service: ServiceDep, person: PersonDep, response: Response) -> Bench:
    """Open a fresh bench that repeats an experiment to its tick, and is then running or paused as the original was.

    `opened` says whether its bits equal the original bits.
    """
    session = await service.idling.open_link(await service.links.get(link_id))
    response.headers["Location"] = f"/api/v1/benches/{session.id}"
    return await service.views.opened(session, person)
