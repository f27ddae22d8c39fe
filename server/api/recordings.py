"""Recordings: every signal of a bench at full rate, in a file."""

from __future__ import annotations

import asyncio
from typing import Annotated, Literal

from fastapi import Query, Response
from pydantic import BaseModel, Field

from server.api.bodies import Body
from server.api.deps import CallerDep, PersonDep, RateLimited, ServiceDep, SessionDep
from server.api.files import FORMAT_RESPONSES, CutDep, stored_trace
from server.api.paging import AgePage
from server.api.router import Router
from server.bench.recording import Wanted
from server.bench.status import Bench
from server.errors import not_found
from server.security.person import Person
from server.service import Service
from server.store.compare import Comparison, compare
from server.store.recordings import Recording, RecordingDetail
from server.store.traces import Format

router = Router(tags=["recordings"])


class Replay(Body):
    """The speed of a replay."""

    speed: float = Field(1.0, ge=0.01, le=10.0, description="Speed as a multiple of the recorded pace")
    paused: bool = Field(False, description="Start paused")


class CompareWith(Body):
    """The recording to compare with, and the tolerances."""

    other: str = Field(description="Id of another recording")
    absolute: float = Field(0.0, ge=0.0, description="Tolerance of every signal, in its unit")
    relative: float = Field(0.0, ge=0.0, description="Further tolerance, as a share of the peak in the first")
    tolerances: dict[str, float] = Field({}, description="Tolerances of single signals in place of both")
    align: Literal["tick", "start"] = Field("tick", description="Compare equal ticks, or ticks from the start")


class RecordingList(BaseModel):
    """Recordings, newest first."""

    recordings: list[Recording]


@router.post("/benches/{bench_id}/recordings", status_code=201, dependencies=[RateLimited])
async def start_recording(
    session: SessionDep, service: ServiceDep, caller: CallerDep, body: Wanted | None = None
) -> Recording:
    """Begin to record now, or when a condition holds, with some of the past; `ticks: 0` keeps only the past."""
    return await service.records.begin(session, body or Wanted(), caller, await service.keeping.room())


@router.post("/benches/{bench_id}/recordings/{recording_id}/stop", dependencies=[RateLimited])
async def stop_recording(recording_id: str, session: SessionDep, service: ServiceDep) -> Recording:
    """End a recording; the answer comes when its file is whole."""
    return await service.records.end(session, recording_id)


@router.get("/benches/{bench_id}/recordings")
async def list_bench_recordings(session: SessionDep, service: ServiceDep, page: AgePage) -> RecordingList:
    """List the recordings of a bench, newest first."""
    return RecordingList(recordings=await service.recordings.all([session.id], page))


@router.get("/recordings")
async def list_recordings(service: ServiceDep, person: PersonDep, page: AgePage) -> RecordingList:
    """List all recordings, newest first, also of deleted benches; a student sees the recordings of the own benches."""
    benches = None if person.is_teacher else service.people.benches_of(person)
    return RecordingList(recordings=await service.recordings.all(benches, page))


@router.get("/recordings/{recording_id}")
async def get_recording(recording_id: str, service: ServiceDep, person: PersonDep) -> RecordingDetail:
    """Describe a recording: scenario, seed, events, versions, layout."""
    recording = await service.recordings.get(recording_id)
    must_see(service, person, recording)
    return recording


@router.delete("/recordings/{recording_id}", status_code=204, dependencies=[RateLimited])
async def delete_recording(recording_id: str, service: ServiceDep) -> None:
    """Delete a recording that has ended."""
    await service.recordings.delete(recording_id)


@router.post("/recordings/{recording_id}/replay", status_code=201, dependencies=[RateLimited])
async def replay_recording(
    recording_id: str, body: Replay, service: ServiceDep, person: PersonDep, response: Response
) -> Bench:
    """Play a recording on a new bench, which takes the commands start, pause, step, seek, loop and time_scale."""
    recording, path = await service.recordings.finished(recording_id)
    session = await service.benches.replay(recording, path, body.speed, body.paused)
    response.headers["Location"] = f"/api/v1/benches/{session.id}"
    return await service.views.opened(session, person)


@router.post("/recordings/{recording_id}/compare")
async def compare_recordings(recording_id: str, body: CompareWith, service: ServiceDep) -> Comparison:
    """Compare two recordings signal by signal: pass or fail."""
    _, first = await service.recordings.finished(recording_id)
    _, second = await service.recordings.finished(body.other)
    async with service.file_turn:
        return await asyncio.to_thread(
            compare, first, second, body.absolute, body.relative, body.tolerances, body.align == "start"
        )


@router.get("/recordings/{recording_id}/trace", response_class=Response, responses=FORMAT_RESPONSES)
async def get_recording_trace(
    recording_id: str,
    service: ServiceDep,
    person: PersonDep,
    cut: CutDep,
    kind: Annotated[Format, Query(alias="format")] = "parquet",
) -> Response:
    """Download a recording, or a part of it."""
    recording, path = await service.recordings.finished(recording_id)
    must_see(service, person, recording)
    return await stored_trace(service, path, recording.name, kind, cut)


def must_see(service: Service, person: Person, recording: RecordingDetail) -> None:
    """Refuse a recording of another's bench, as if it were not there."""
    if not service.people.may_see_recordings(person, recording.bench_id):
        raise not_found("recording", recording.id)
