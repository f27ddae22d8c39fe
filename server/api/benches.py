"""Live benches: make, look at, command, fork, save, close."""

from __future__ import annotations

from typing import Annotated, Any, Self

from fastapi import Body, Response
from pydantic import BaseModel, Field, model_validator

from core.own.admission import kept
from scenarios.schema import Scenario
from server.api.bodies import Body as StrictBody
from server.api.bodies import Source, Values
from server.api.deps import CallerDep, PersonDep, RateLimited, SeenDep, ServiceDep, SessionDep
from server.api.paging import AgePage, Number, pages
from server.api.router import Router
from server.bench.commands import DEFAULT_SCALE, MAX_SCALE, MIN_SCALE, Command
from server.bench.description import document_of
from server.bench.events import KEPT, Event
from server.bench.record_work import record_document
from server.bench.status import Bench
from server.bench.view import View
from server.classroom.hiding import HINT, blind_of
from server.errors import ApiError
from server.paging import ListPage
from server.security.person import Person
from server.service import Service

MAX_NAME = 80

router = Router(prefix="/benches", tags=["benches"])


class NewBench(StrictBody):
    """The scenario of a new bench, and how it starts."""

    scenario: Source
    set: Values = Field({})
    seed: int | None = Field(None, ge=0, le=2**53, description="Null: the seed of the scenario")
    paused: bool = Field(False, description="Start paused")
    keep: bool = Field(False, description="Never close the bench for being unused; for the teacher alone")
    time_scale: float | None = Field(
        DEFAULT_SCALE,
        ge=MIN_SCALE,
        le=MAX_SCALE,
        description="Device seconds per wall second; null: as fast as possible; left out: usual for the device",
    )
    quiet_lead: bool = Field(
        False,
        description=(
            "Run as fast as possible until two seconds of wall time before the first command of the scenario that "
            "waits for a tick, and at the time scale from there on. A reset begins this again, and a time_scale "
            "command ends it. The bits stay the same"
        ),
    )

    def wanted(self) -> dict[str, Any]:
        """Return the arguments of `Benches.create`."""
        return {
            "source": self.scenario,
            "values": self.set,
            "seed": self.seed,
            "paused": self.paused,
            "time_scale": self.time_scale,
            "own_scale": "time_scale" not in self.model_fields_set,
            "quiet_lead": self.quiet_lead,
        }

    @model_validator(mode="after")
    def _has_a_pace(self) -> Self:
        if self.quiet_lead and self.time_scale is None:
            raise ValueError("quiet_lead needs a time_scale to continue at")
        return self


class NewBenchHere(NewBench):
    """A new bench, which may play a record of this server, and have a device that a record calibrated."""

    record: str = Field("", max_length=40, description="Id of the record that plays in place of its plant; empty: none")
    device: str = Field("", max_length=40, description="Id of a measured device; empty: the scenario's own")


class BenchList(BaseModel):
    """The live benches, oldest first."""

    benches: list[Bench]


class CommandResult(BaseModel):
    """A command that was carried out, and the tick at which it took effect."""

    tick: int
    time_ms: float
    entry: Event


class EventList(BaseModel):
    """Events after a number."""

    events: list[Event]
    last: int = Field(description="Number of the newest event of the bench")
    lost: int = Field(description="Number of events after the number that the bench no longer keeps")


class Digest(BaseModel):
    """The digest of a run, equal for equal runs: SHA-256 over a fold of the outputs of each block at every tick."""

    tick: int
    digest: str


class ForkFrom(StrictBody):
    """The start of a fork."""

    snapshot: str | None = Field(None, description="Id of a snapshot to fork from; null: the tick, or the present")
    tick: int | None = Field(None, ge=0, le=2**53, description="A past tick, computed again; null: the snapshot")
    before: bool = Field(False, description="Leave out the commands at this tick")
    window_ticks: int = Field(
        20_000, ge=0, le=1_000_000, description="Earlier ticks that are computed again for its panels"
    )
    paused: bool = Field(False, description="Start paused; the fork may seek other ticks until its first change")
    name: str = Field("", max_length=MAX_NAME, description="Name of the fork, in addition to the title of its scenario")

    @model_validator(mode="after")
    def _has_one_moment(self) -> Self:
        if self.tick is not None and self.snapshot is not None:
            raise ValueError("give a snapshot or a tick, not both")
        if self.tick is None and self.before:
            raise ValueError("before needs a tick")
        return self


class BenchName(StrictBody):
    """Name of a bench."""

    name: str = Field(max_length=MAX_NAME, description="Name of the bench; empty: only the title of its scenario")


class Variant(StrictBody):
    """The difference between a bench and its variant."""

    set: dict[str, Any] = Field({}, description="Values by dotted path; a value may be a whole table")
    repeat: bool = Field(False, description="Repeat the commands to this bench up to its tick, and pause there")


@router.post("", status_code=201, dependencies=[RateLimited])
async def create_bench(body: NewBenchHere, service: ServiceDep, person: PersonDep, response: Response) -> Bench:
    """Make a bench and start it; the new bench of a student replaces the earlier one."""
    if person.role == "watcher":
        raise ApiError(403, "forbidden", "a link to watch opens one bench")
    body = await _with_record(body, service, person)
    await service.benches.check(body.scenario, body.set)
    if person.role == "student":
        blind = blind_of(await service.student_benches.get(person))  # it may be on its way back
        if blind is not None and blind.question.game is None:  # a game may be left
            raise ApiError(409, "blind", "a fault is hidden on your bench", hint=HINT)
        service.driving.check(service.people.bench_of(person), person)  # the bench before is closed with it
        session = await service.student_benches.replace(person, body.wanted())
    else:
        session = await service.benches.create(**body.wanted())
        session.keep = body.keep
    response.headers["Location"] = f"/api/v1/benches/{session.id}"
    return await service.views.opened(session, person)


async def _with_record(body: NewBenchHere, service: Service, person: Person) -> NewBenchHere:
    """Put the record and the measured device of a request into its scenario and its values."""
    changes: dict[str, Any] = {}
    if body.device:
        device = await service.measured_devices.get(body.device)
        changes["set"] = {**device.for_bench(plays_record=bool(body.record)), **body.set}
    if body.record:
        record = await service.measured_records.get(body.record, None if person.is_teacher else person.id)
        units = service.units.beside({})
        changes["scenario"] = await service.computing.call(record_document, body.scenario, units, record.key)
    return body.model_copy(update=changes)


@router.get("")
async def list_benches(service: ServiceDep, person: PersonDep, page: AgePage) -> BenchList:
    """List the live benches of the teacher; a class lists the benches of its students. A student gets the own bench."""
    if person.is_teacher:
        return BenchList(benches=service.views.all(person, page))
    found = service.benches.find(service.people.bench_of(person))
    return BenchList(benches=[service.views.of(found, person)] if found is not None else [])


@router.get("/{bench_id}")
async def get_bench(session: SessionDep, service: ServiceDep, person: PersonDep) -> Bench:
    """Describe a bench."""
    return service.views.of(session, person)


@router.patch("/{bench_id}", dependencies=[RateLimited])
async def name_bench(body: BenchName, session: SessionDep, service: ServiceDep, person: PersonDep) -> Bench:
    """Name a bench, for example a branch by its difference."""
    session.name = body.name
    return service.views.of(session, person)


@router.delete("/{bench_id}", status_code=204, dependencies=[RateLimited])
async def delete_bench(session: SessionDep, service: ServiceDep) -> None:
    """Close a bench; its recordings stay."""
    await service.close_bench(session)


@router.post("/{bench_id}/reopen", dependencies=[RateLimited])
async def reopen_bench(bench_id: str, service: ServiceDep, person: PersonDep) -> Bench:
    """Return a bench; a closed idle bench is opened again under its id, with the same bits, paused or running."""
    session = await service.idling.bring_back(bench_id)
    service.idling.saw(bench_id)
    return service.views.of(session, person)


@router.post("/{bench_id}/commands", dependencies=[RateLimited])
async def command(
    command: Annotated[Command, Body()], session: SessionDep, service: ServiceDep, person: PersonDep, caller: CallerDep
) -> CommandResult:
    """Carry out a command at the next tick edge.

    Commands to the board are events of a scenario; their earlier notation, by the kinds inject, heal, set, switch and
    reset_trip, is still read.
    """
    entry = await service.benches.command(session, command, caller)
    if isinstance(seen := service.views.seen(session, person), View):
        entry = seen.told(entry)
    return CommandResult(tick=entry.tick, time_ms=entry.tick * session.dt_ms, entry=entry)


@router.get("/{bench_id}/events")
async def list_events(
    session: SeenDep, page: Annotated[ListPage, pages(Number, usual=KEPT, most=100_000)]
) -> EventList:
    """List the events of a bench, oldest first; `after` is the number of an event, whose followers are listed."""
    lost, events = session.events.after(page.after[0] if page.after else 0)
    return EventList(events=page.rows(events, lambda one: (one.seq,)), last=session.events.last, lost=lost)


@router.get("/{bench_id}/scenario", response_class=Response, responses={200: {"content": {"text/plain": {}}}})
async def save_scenario(session: SessionDep, service: ServiceDep) -> Response:
    """Return the history of a bench as a scenario in TOML.

    Its second line has the digest. Run headless, it gives the same bits.
    """
    document, tick, digest = await service.engine.call(
        lambda: (document_of(session), session.board.tick, session.board.digest())
    )
    name = f'attachment; filename="{document["id"]}.toml"'
    with kept():
        text = Scenario.load(document).toml(f"{tick} ticks, digest {digest}")
    return Response(text, media_type="text/plain", headers={"Content-Disposition": name})


@router.get("/{bench_id}/digest")
async def get_digest(session: SessionDep, service: ServiceDep) -> Digest:
    """Return the digest of the trace so far."""
    tick, digest = await service.engine.call(lambda: (session.board.tick, session.board.digest()))
    return Digest(tick=tick, digest=digest)


@router.post("/{bench_id}/fork", status_code=201, dependencies=[RateLimited])
async def fork_bench(
    body: ForkFrom, session: SessionDep, service: ServiceDep, person: PersonDep, response: Response
) -> Bench:
    """Make a second bench that continues from this moment, a snapshot or a tick of the past, bit for bit."""
    travels = service.benches.travels
    if body.tick is None:
        twin = await travels.fork(session, body.snapshot, paused=body.paused)
    else:
        twin = await travels.fork_at(session, body.tick, body.window_ticks, is_before=body.before, paused=body.paused)
    twin.name = body.name
    response.headers["Location"] = f"/api/v1/benches/{twin.id}"
    return await service.views.opened(twin, person)


@router.post("/{bench_id}/variant", status_code=201, dependencies=[RateLimited])
async def vary_bench(
    body: Variant, session: SessionDep, service: ServiceDep, person: PersonDep, response: Response
) -> Bench:
    """Make a second bench from tick 0, set as this one is now but for some values; other signals are allowed.

    With ``repeat`` it begins as this bench began, but with the values, and the commands to this bench are repeated.
    """
    travels = service.benches.travels
    made = await (travels.repeated if body.repeat else travels.variant)(session, body.set)
    response.headers["Location"] = f"/api/v1/benches/{made.id}"
    return await service.views.opened(made, person)
