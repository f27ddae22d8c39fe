"""Progress as server-sent events: of a run, a campaign, a search for a threshold, a recording under way."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import Header, Response
from fastapi.responses import StreamingResponse
from starlette.types import Receive, Scope, Send

from server.api.deps import PersonDep, ServiceDep
from server.api.recordings import must_see
from server.api.router import Router
from server.errors import not_found
from server.progress import Ending, Look, ProgressStreams, WorkProgress
from server.runs.queue import Requested
from server.security.person import Person
from server.service import Service
from server.store.recordings import OPEN

router = Router(tags=["progress"])

HEADERS = {"Cache-Control": "no-store, no-transform", "X-Accel-Buffering": "no"}
"""No proxy keeps the events back or compresses them."""
LastEvent = Annotated[
    str, Header(alias="Last-Event-ID", max_length=200, description="Id of the last event that was received")
]


class ProgressResponse(StreamingResponse):
    """The events of some work; its stream counts as long as it is open."""

    media_type = "text/event-stream"

    def __init__(self, streams: ProgressStreams, person: Person, look: Look, known: str) -> None:
        super().__init__(streams.events(look, known), headers=HEADERS)
        self._streams, self._reader = streams, person.id

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the events; the answer to HEAD has none."""
        if scope.get("is_head"):
            await Response(media_type=self.media_type, headers=HEADERS)(scope, receive, send)
            return
        with self._streams.place(self._reader):
            await super().__call__(scope, receive, send)


def _door(result: str) -> dict[str, Any]:
    """Describe a door of progress, whose last event has the model of this name."""
    data = [{"$ref": f"#/components/schemas/{name}"} for name in ("WorkProgress", result)]
    event = {
        "type": "object",
        "required": ["event", "data", "id"],
        "properties": {
            "event": {"type": "string", "enum": ["progress", "done", "failed", "cancelled"]},
            "data": {"anyOf": data, "description": f"JSON: WorkProgress, in the last event {result}"},
            "id": {"type": "string", "description": "For the header Last-Event-ID"},
        },
    }
    about = f"Events `progress` with a WorkProgress, then one of `done`, `failed` and `cancelled` with the {result}"
    content = {"text/event-stream": {"schema": {"description": about}, "x-item-schema": event}}
    gone = {"description": "The last event is known already: there is nothing left to wait for"}
    return {
        "response_class": Response,
        "responses": {200: {"description": about, "content": content}, 204: gone},
    }


@router.get("/runs/{run_id}/progress", **_door("Run"))
async def follow_run(run_id: str, service: ServiceDep, person: PersonDep, known: LastEvent = "") -> Response:
    """Follow a run to its end."""
    return await _follow_request(service, person, service.jobs, run_id, known)


@router.get("/sweeps/{sweep_id}/progress", **_door("SweepRun"))
async def follow_sweep(sweep_id: str, service: ServiceDep, person: PersonDep, known: LastEvent = "") -> Response:
    """Follow a campaign to its end."""
    return await _follow_request(service, person, service.sweeps, sweep_id, known)


@router.get("/thresholds/{threshold_id}/progress", **_door("ThresholdRun"))
async def follow_threshold(
    threshold_id: str, service: ServiceDep, person: PersonDep, known: LastEvent = ""
) -> Response:
    """Follow a search for a threshold to its end."""
    return await _follow_request(service, person, service.thresholds, threshold_id, known)


@router.get("/recordings/{recording_id}/progress", **_door("Recording"))
async def follow_recording(
    recording_id: str, service: ServiceDep, person: PersonDep, known: LastEvent = ""
) -> Response:
    """Follow a recording until its file is whole."""

    async def look() -> WorkProgress | Ending | None:
        if not service.people.lasts(person) or service.views.is_blind(person, ""):
            raise not_found("recording", recording_id)
        if (progress := service.records.progress(recording_id)) is not None:
            return progress
        recording = await service.recordings.get(recording_id)
        return None if recording.state in OPEN else Ending(state=recording.state, result=recording)

    must_see(service, person, await service.recordings.get(recording_id))
    return await _follow(service, person, look, known)


async def _follow_request(service: Service, person: Person, kind: Requested[Any], row_id: str, known: str) -> Response:
    await kind.get(row_id)
    return await _follow(service, person, lambda: kind.look(row_id), known)


async def _follow(service: Service, person: Person, look: Look, known: str) -> Response:
    """Answer with the events of some work, unless its end is known or too many streams are open."""
    now = await look()
    if isinstance(now, Ending) and now.id == known:
        return Response(status_code=204)  # a browser connects no more
    service.progress.check_room(person.id, person.is_teacher)
    return ProgressResponse(service.progress, person, look, known)
