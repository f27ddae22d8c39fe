"""User units: texts for a start, a check during typing, the units that this server keeps."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import suppress
from operator import itemgetter
from typing import Annotated, Literal

from fastapi import Path
from pydantic import BaseModel, Field

from core.board.library import IDENTIFIER
from core.cards import BlockCard, card
from core.errors import InputError
from core.own.admission import check_admitted, refusal
from core.own.text import UnitError
from core.own.unit import Unit, unit
from scenarios.own import copies
from scenarios.starters import starters
from server.api.bodies import Body
from server.api.deps import RateLimited, ServiceDep
from server.api.paging import Number, pages
from server.api.router import Router
from server.bench.build import prepare
from server.errors import not_found
from server.paging import ListPage
from server.service import Service

router = Router(prefix="/units", tags=["units"])

USUAL = "first-look"
Origin = Literal["starter", "library", "folder", "command line"]
Name = Annotated[str, Field(pattern=IDENTIFIER.pattern, description="Small letters, digits and _, first a letter")]
NamePath = Annotated[str, Path(pattern=IDENTIFIER.pattern, description="Name of a unit")]


class UnitEntry(BaseModel):
    """A unit whose text can be read and copied."""

    family: str
    name: str
    title: str
    origin: Origin = Field(description="Starter text, library, folder of this server, or file given at its start")
    hash: str = Field(description="SHA-256 of its text")


class UnitList(BaseModel):
    """Units to begin with: of this server, then the starters, then the library."""

    units: list[UnitEntry]
    refusal: str = Field(description="Why the caller may not use own units; empty: allowed")


class UnitText(UnitEntry):
    """A unit with its text."""

    source: str


class UnitDraft(Body):
    """A text to check."""

    name: Name
    source: str


class UnitSource(Body):
    """The text of a unit."""

    source: str


class CheckedUnit(BaseModel):
    """A unit that can be used."""

    card: BlockCard = Field(description="Card of the unit, as in the catalogue")
    operations: int = Field(description="Largest number of operations for one sample")
    hash: str = Field(description="SHA-256 of its text")


class UnitMistake(BaseModel):
    """An error in a text, and its place; line and column begin with 1."""

    message: str
    line: int
    column: int


class UnitCheck(BaseModel):
    """A unit, or the errors in its text."""

    unit: CheckedUnit | None
    error: UnitMistake | None = Field(description="The first error")
    errors: list[UnitMistake] = Field(description="All errors, in the order of the text")


@router.get("")
def list_units(service: ServiceDep, page: Annotated[ListPage, pages(Number, str)]) -> UnitList:
    """List the units to begin with, and whether this person may bring any."""
    first_fixed = len(service.units.all())
    rows = [
        ((max(number - first_fixed + 1, 0), one.name), _entry(one, origin))
        for number, (one, origin) in enumerate(_readable(service))
    ]
    return UnitList(units=[entry for _, entry in page.cut(rows, itemgetter(0))], refusal=refusal())


@router.get("/{name}")
def get_unit(name: NamePath, service: ServiceDep) -> UnitText:
    """Return the text of a unit."""
    for one, origin in _readable(service):
        if one.name == name:
            return UnitText(**dict(_entry(one, origin)), source=one.source)
    raise not_found("unit", name, "list them at /api/v1/units", known=(one.name for one, _ in _readable(service)))


@router.post("", dependencies=[RateLimited])
async def check_unit(body: UnitDraft, service: ServiceDep) -> UnitCheck:
    """Check the text of a unit; nothing is compiled and nothing is kept."""
    check_admitted({"units": {body.name: body.source}})
    return await service.computing.call(_checked, body.name, body.source)


def _checked(name: str, source: str) -> UnitCheck:
    try:
        one = unit(name, source)
    except UnitError as error:
        return _refused([UnitMistake(message=each.message, line=each.line, column=each.column) for each in error.all])
    except InputError as error:
        return _refused([UnitMistake(message=str(error), line=1, column=1)])
    checked = CheckedUnit(card=card(one.block), operations=one.operations, hash=one.hash)
    return UnitCheck(unit=checked, error=None, errors=[])


def _refused(errors: list[UnitMistake]) -> UnitCheck:
    return UnitCheck(unit=None, error=errors[0], errors=errors)


@router.put("/{name}", dependencies=[RateLimited])
async def keep_unit(name: NamePath, body: UnitSource, service: ServiceDep) -> UnitEntry:
    """Keep a unit in the folder of this server: every new bench has it, and runs that name it."""
    check_admitted({"units": {name: body.source}})
    own = {f"units.{name}.source": body.source}
    await service.computing.call(_tried, own)

    def kept() -> Unit:
        try:
            one = service.units.check(name, body.source)
        except UnitError as error:
            raise error.under("source") from None
        prepare(USUAL, own, None)  # it is compiled now, and every new bench can have it
        service.units.keep(one)
        return one

    return _entry(await asyncio.to_thread(kept), "folder")


def _tried(own: dict[str, str]) -> None:
    """Make a bench of a unit; whatever is wrong with it is said where it is kept."""
    with suppress(InputError):
        prepare(USUAL, own, None, compiled=False)


@router.delete("/{name}", status_code=204, dependencies=[RateLimited])
def delete_unit(name: NamePath, service: ServiceDep) -> None:
    """Delete a unit from the folder of this server; benches that have it keep it."""
    service.units.remove(name)


def _readable(service: Service) -> Iterator[tuple[Unit, Origin]]:
    """Return the units of this server, then the units that come with CombBench, each with its origin."""
    for one in service.units.all():
        yield one, "folder" if service.units.is_kept(one.name) else "command line"
    yield from ((one, "starter") for one in starters())
    yield from ((one, "library") for one in copies())


def _entry(one: Unit, origin: Origin) -> UnitEntry:
    return UnitEntry(family=one.family, name=one.name, title=one.block.title, origin=origin, hash=one.hash)
