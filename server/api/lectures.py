"""Lectures: cues that a teacher goes through, each an exact state of a bench."""

from __future__ import annotations

import asyncio

from pydantic import BaseModel, Field

from scenarios.lecture import Lecture, Question
from scenarios.lectures import lecture, lecture_ids
from server.api.bodies import AnswerBody, Body
from server.api.deps import CallerDep, PersonDep, RateLimited, ServiceDep
from server.api.router import Router
from server.bench.status import Bench
from server.errors import ApiError, not_found

router = Router(prefix="/lectures", tags=["lectures"])


class LectureCard(AnswerBody):
    """A lecture among others."""

    id: str
    title: str
    chapter: int
    summary: str
    minutes: float = Field(description="Planned length in minutes")
    cues: int


class LectureList(BaseModel):
    """The lectures, in the order of the chapters."""

    lectures: list[LectureCard]


class CueDetail(AnswerBody):
    """A cue: the notes of the speaker, and the panels of the bench."""

    title: str
    minutes: float
    say: str
    ask: str
    see: str
    from_ms: float
    until_ms: float
    layout: str | None
    panels: list[str]
    signals: list[str]
    window_ms: float | None
    vote: Question | None


class LectureDetail(LectureCard):
    """A lecture with all its cues."""

    script: list[CueDetail]


class OnBench(Body):
    """The bench that is put into the state of a cue, if it has the same signals."""

    bench: str | None = Field(None, description="Id of a bench; null: a new bench is made")


class Staged(BaseModel):
    """The bench in the state of a cue; a fresh bench where the given bench has other signals."""

    bench: Bench
    tick: int
    digest: str = Field(description="Digest of the bits up to this tick, equal each time")


@router.get("")
async def list_lectures() -> LectureList:
    """List the lectures."""
    found = await asyncio.to_thread(lambda: [lecture(name) for name in lecture_ids()])
    return LectureList(lectures=[LectureCard.of(one.head, one, cues=len(one.head.cues)) for one in found])


@router.get("/{lecture_id}")
async def get_lecture(lecture_id: str) -> LectureDetail:
    """Return a lecture: its cues with the notes of the speaker."""
    found = await _get(lecture_id)
    script = []
    for cue, state in zip(found.head.cues, found.states, strict=True):
        dt_ms = state.scenario.spec.dt_ms
        script.append(CueDetail.of(cue, from_ms=state.from_tick * dt_ms, until_ms=state.until_tick * dt_ms))
    return LectureDetail.of(found.head, found, cues=len(script), script=script)


@router.post("/{lecture_id}/cues/{number}", dependencies=[RateLimited])
async def put_cue(
    lecture_id: str, number: int, body: OnBench, service: ServiceDep, caller: CallerDep, person: PersonDep
) -> Staged:
    """Put a bench into the exact state of a cue, counted from 1; a cue that has a length runs from there to its end."""
    found = await _get(lecture_id)
    if not 1 <= number <= len(found.head.cues):
        raise ApiError(404, "not_found", f"there is no cue {number}: {lecture_id} has {len(found.head.cues)}", "number")
    cue, state = found.head.cues[number - 1], found.states[number - 1]
    session = service.benches.get(body.bench) if body.bench is not None else None
    if session is not None and (session.class_id or session.replay_of or session.view is not None):
        text = "a student's bench, a recording or a bench with a hidden fault is no stage of a lecture"
        raise ApiError(409, "conflict", text, "bench")
    pace = None if cue.pace_ms_per_s is None else cue.pace_ms_per_s / 1e3
    text = f"cue {number} of {found.head.title}: {cue.title}"
    async with service.experiment_turn:
        staged, digest = await service.benches.travels.cue(session, state, pace, caller, text)
    return Staged(bench=await service.views.opened(staged, person), tick=state.from_tick, digest=digest)


async def _get(lecture_id: str) -> Lecture:
    """Return a lecture, or refuse with 404; reading one wires the bench of every cue."""
    if lecture_id not in lecture_ids():
        raise not_found("lecture", lecture_id, f"there are: {', '.join(lecture_ids())}", known=lecture_ids())
    return await asyncio.to_thread(lecture, lecture_id)
