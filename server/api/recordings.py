"""Recordings: every signal of a bench at full rate, in a file."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response
from pydantic import BaseModel, Field

from server.api.bodies import Body, StrictRoute
from server.api.deps import CallerDep, RateLimited, ServiceDep, SessionDep
from server.api.files import FORMAT_RESPONSES, stored_trace
from server.errors import not_found
from server.store.recordings import Recording
from server.store.traces import Format

router = APIRouter(tags=["recordings"], route_class=StrictRoute)


class NewRecording(Body):
    """What to call a recording."""

    name: str = Field("recording", min_length=1, max_length=100)


class RecordingList(BaseModel):
    """Recordings, newest first."""

    recordings: list[Recording]


@router.post("/benches/{bench_id}/recordings", status_code=201, dependencies=[RateLimited])
async def start_recording(
    session: SessionDep, service: ServiceDep, caller: CallerDep, body: NewRecording | None = None
) -> Recording:
    """Begin to record."""
    return await service.benches.record(session, body.name if body else "recording", caller)


@router.post("/benches/{bench_id}/recordings/{recording_id}/stop", dependencies=[RateLimited])
async def stop_recording(recording_id: str, session: SessionDep, service: ServiceDep) -> Recording:
    """End a recording; answers when its file is whole."""
    return await service.benches.stop_recording(session, recording_id)


@router.get("/benches/{bench_id}/recordings")
async def list_bench_recordings(session: SessionDep, service: ServiceDep) -> RecordingList:
    """List the recordings of a bench."""
    return RecordingList(recordings=await service.recordings.all(session.id))


@router.get("/recordings")
async def list_recordings(service: ServiceDep) -> RecordingList:
    """List all recordings, of benches that are gone as well."""
    return RecordingList(recordings=await service.recordings.all())


@router.get("/recordings/{recording_id}")
async def get_recording(recording_id: str, service: ServiceDep) -> Recording:
    """Describe a recording."""
    return await service.recordings.get(recording_id)


@router.get("/recordings/{recording_id}/trace", response_class=Response, responses=FORMAT_RESPONSES)
async def get_recording_trace(
    recording_id: str, service: ServiceDep, kind: Annotated[Format, Query(alias="format")] = "parquet"
) -> Response:
    """Download a recording."""
    recording = await service.recordings.get(recording_id)
    path = service.recordings.path(recording.id)
    if recording.state == "recording" or not path.is_file():
        raise not_found("finished trace of recording", recording_id, "stop the recording first")
    return await stored_trace(service, path, recording.name, kind)
