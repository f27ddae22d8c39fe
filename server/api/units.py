"""User units: texts for a start, a check during typing, the units that this server keeps."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import suppress
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
from server.api.deps import ComputingDep, RateLimited, ServiceDep
from server.api.router import Router
from server.bench.build import prepare
from server.errors import not_found

router = Router(prefix="/units", tags=["units"])

USUAL = "first-look"
Origin = Literal["starter", "library", "folder", "command line"]
Name = Annotated[str, Field(pattern=IDENTIFIER.pattern, description="Small letters, digits and _, a letter first")]
NamePath = Annotated[str, Path(pattern=IDENTIFIER.pattern, description="Name of a unit")]


class UnitEntry(BaseModel):
    """A unit whose text can be read and copied."""

    family: str
    name: str
    title: str
    origin: Origin = Field(
        description="A text to begin with, the library, the folder of this server, or a file it was started with"
    )
    hash: str = Field(description="SHA-256 of its text")


class UnitList(BaseModel):
    """Units to begin with: of this server, then the starters, then the library."""

    units: list[UnitEntry]
    refusal: str = Field(description="Why this person may not bring units of their own; empty: they may")


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

    card: BlockCard = Field(description="As the catalogue would have it")
    operations: int = Field(description="Most operations of a sample")
    hash: str = Field(description="SHA-256 of its text")


class UnitMistake(BaseModel):
    """An error in a text, and its place; line and column begin with 1."""

    message: str
    line: int
    column: int


class UnitCheck(BaseModel):
    """A unit, or the errors in its text."""

    unit: CheckedUnit | None
    error: UnitMistake | None


@router.get("")
def list_units(service: ServiceDep) -> UnitList:
    """List the units to begin with, and whether this person may bring any."""
    own = [_entry(one, "folder" if service.units.is_kept(one.name) else "command line") for one in service.units.all()]
    return UnitList(units=[*own, *(_entry(one, origin) for one, origin in _offered())], refusal=refusal())


@router.get("/{name}")
def get_unit(name: NamePath, service: ServiceDep) -> UnitText:
    """Return the text of a unit."""
    one = service.units.find(name)
    if one is not None:
        return _text(one, "folder" if service.units.is_kept(name) else "command line")
    for one, origin in _offered():
        if one.name == name:
            return _text(one, origin)
    known = (one.name for one in (*service.units.all(), *(one for one, _ in _offered())))
    raise not_found("unit", name, "list them at /api/v1/units", known=known)


@router.post("", dependencies=[RateLimited])
async def check_unit(body: UnitDraft, computing: ComputingDep) -> UnitCheck:
    """Check the text of a unit; nothing is compiled and nothing is kept."""
    check_admitted({"units": {body.name: body.source}})
    return await computing.call(_checked, body.name, body.source)


def _checked(name: str, source: str) -> UnitCheck:
    try:
        one = unit(name, source)
    except UnitError as error:
        return UnitCheck(unit=None, error=UnitMistake(message=error.message, line=error.line, column=error.column))
    except InputError as error:
        return UnitCheck(unit=None, error=UnitMistake(message=str(error), line=1, column=1))
    return UnitCheck(unit=CheckedUnit(card=card(one.block), operations=one.operations, hash=one.hash), error=None)


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


def _offered() -> Iterator[tuple[Unit, Origin]]:
    """Return the texts that come with CombBench."""
    yield from ((one, "starter") for one in starters())
    yield from ((one, "library") for one in copies())


def _entry(one: Unit, origin: Origin) -> UnitEntry:
    return UnitEntry(family=one.family, name=one.name, title=one.block.title, origin=origin, hash=one.hash)


def _text(one: Unit, origin: Origin) -> UnitText:
    return UnitText(**dict(_entry(one, origin)), source=one.source)
