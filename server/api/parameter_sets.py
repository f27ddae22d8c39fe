"""Named sets of parameters: save the parameters of a bench, apply them to another, compare two sets."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import Query
from pydantic import BaseModel, Field

from core.board.commands import SetValues
from core.board.tuning import absent, difference, tuned
from server.api.benches import CommandResult
from server.api.bodies import Body
from server.api.deps import CallerDep, PersonDep, RateLimited, ServiceDep, SessionDep
from server.api.paging import pages
from server.api.router import Router
from server.classroom.access import Need
from server.errors import ApiError
from server.paging import ListPage
from server.store.parameter_sets import ParameterSet, ParameterSetDetail

router = Router(tags=["parameter sets"])


class SetName(Body):
    """The name of a set."""

    name: str = Field(min_length=1, max_length=100, description="Name, which no other set may have")


class ParameterSetList(BaseModel):
    """Sets by name."""

    sets: list[ParameterSet]


class Differs(BaseModel):
    """A parameter with different values in two sets; null: the set has no value, or leaves it to the block."""

    path: str
    first: Any
    second: Any


class Difference(BaseModel):
    """Where two sets differ."""

    rows: list[Differs]
    same: int = Field(description="Parameters with the same value in both")


class Applied(BaseModel):
    """The changes of a bench by a set."""

    result: CommandResult | None = Field(description="The command that set the values; null: none was needed")
    left_out: list[str] = Field(description="Paths of the set that this bench does not have")


@router.post("/benches/{bench_id}/parameter-sets", status_code=201, dependencies=[RateLimited])
async def save_parameter_set(body: SetName, session: SessionDep, service: ServiceDep) -> ParameterSetDetail:
    """Keep every value of a bench that may change while it runs."""
    values = await service.engine.call(lambda: tuned(session.board.spec))
    return await service.parameter_sets.save(body.name, session.scenario.id, values)


@router.post("/benches/{bench_id}/parameter-sets/{set_id}", dependencies=[RateLimited])
async def apply_parameter_set(set_id: str, session: SessionDep, service: ServiceDep, caller: CallerDep) -> Applied:
    """Give a bench the values of a set, all in one tick."""
    wanted = (await service.parameter_sets.get(set_id)).values

    def compared() -> tuple[dict[str, Any], list[str]]:
        spec = session.board.spec
        return difference(spec, wanted), absent(spec, wanted)

    values, left_out = await service.engine.call(compared)
    if not values:
        return Applied(result=None, left_out=left_out)
    entry = await service.benches.command(session, SetValues(set=values), caller)
    result = CommandResult(tick=entry.tick, time_ms=entry.tick * session.dt_ms, entry=entry)
    return Applied(result=result, left_out=left_out)


@router.get("/parameter-sets")
async def list_parameter_sets(service: ServiceDep, page: Annotated[ListPage, pages(str)]) -> ParameterSetList:
    """List the sets by name."""
    return ParameterSetList(sets=await service.parameter_sets.all(page))


@router.get("/parameter-sets/{set_id}")
async def get_parameter_set(set_id: str, service: ServiceDep) -> ParameterSetDetail:
    """Return a set with its values."""
    return await service.parameter_sets.get(set_id)


@router.get("/parameter-sets/{set_id}/difference")
async def compare_parameter_sets(
    set_id: str,
    service: ServiceDep,
    person: PersonDep,
    other: Annotated[str | None, Query(description="Id of another set")] = None,
    bench: Annotated[str | None, Query(description="Id of a bench, whose present values are compared")] = None,
) -> Difference:
    """Say where a set differs from another set or from a bench."""
    first = (await service.parameter_sets.get(set_id)).values
    if (other is None) == (bench is None):
        raise ApiError(422, "invalid", "needs one of other and bench", "other")
    if other is not None:
        second = (await service.parameter_sets.get(other)).values
    else:
        if not service.people.may(person, Need.WATCH, bench or ""):
            raise ApiError(403, "forbidden", "only the owner of this bench may do that", "bench")
        session = service.views.whole(bench or "", person)
        second = await service.engine.call(lambda: tuned(session.board.spec))
    rows = [
        Differs(path=path, first=first.get(path), second=second.get(path))
        for path in sorted({*first, *second})
        if first.get(path) != second.get(path)
    ]
    return Difference(rows=rows, same=len({*first, *second}) - len(rows))


@router.patch("/parameter-sets/{set_id}", dependencies=[RateLimited])
async def rename_parameter_set(set_id: str, body: SetName, service: ServiceDep) -> ParameterSetDetail:
    """Give a set another name."""
    return await service.parameter_sets.rename(set_id, body.name)


@router.delete("/parameter-sets/{set_id}", status_code=204, dependencies=[RateLimited])
async def delete_parameter_set(set_id: str, service: ServiceDep) -> None:
    """Forget a set."""
    await service.parameter_sets.delete(set_id)
