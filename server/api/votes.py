"""Votes: a question to a class or to the room; the counts are shown once the teacher reveals them."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field

from scenarios.lecture import Span
from server.api.bodies import Body
from server.api.deps import PersonDep, RateLimited, ServiceDep
from server.api.paging import pages
from server.api.router import Router
from server.classroom.votes import Asked, Ballot, OpenVote, Vote
from server.errors import ApiError
from server.paging import ListPage

router = Router(tags=["votes"])

MOST_WORDS, MOST_LANES = 6, 12


class NewVote(Body):
    """A question: two to six answers in words, or the hypotheses of a diagnoser, at most twelve."""

    class_id: str | None = Field(None, max_length=32, description="Id of the class; null: by raised hands")
    text: str = Field(min_length=1, max_length=300)
    answers: list[Annotated[str, Field(min_length=1, max_length=100)]] = Field(min_length=2, max_length=MOST_LANES)
    diagnoser: str = Field("", max_length=64, description="Id of a diagnoser, whose hypotheses are the answers")
    when: Span | None = Field(None, description="Span of device time in which a moment is guessed; null: no guess")
    right: str = Field("", max_length=100, description="The right answer, which is shown with the counts; empty: none")


class Hands(Body):
    """Hands raised in the room, for each answer."""

    counts: list[Annotated[int, Field(ge=0, le=10_000)]] = Field(max_length=MOST_LANES)


class NewBallot(Body):
    """The answer of a student."""

    vote: str = Field(max_length=32)
    answer: int = Field(ge=0, lt=MOST_LANES, description="Position of the answer in the list, from 0")
    at_ms: float | None = Field(None, description="Guessed moment of device time, ms; null: no guess")


class VoteList(BaseModel):
    """The votes."""

    votes: list[Vote]


@router.post("/votes", status_code=201, dependencies=[RateLimited])
async def open_vote(body: NewVote, service: ServiceDep) -> Vote:
    """Ask a class, or the room; one vote of a class is open at a time."""
    if len(set(body.answers)) < len(body.answers):
        raise ApiError(422, "invalid", "must all be different", "answers")
    if not body.diagnoser and len(body.answers) > MOST_WORDS:
        raise ApiError(422, "invalid", f"at most {MOST_WORDS}, unless they are the lanes of a diagnoser", "answers")
    if body.right and body.right not in body.answers:
        raise ApiError(422, "invalid", "must be one of the answers", "right")
    if body.class_id is not None:
        await service.classes.row(body.class_id)
    asked = Asked(text=body.text, answers=body.answers, diagnoser=body.diagnoser, when=body.when)
    return await service.votes.open(body.class_id, asked, body.right)


@router.get("/votes")
async def list_votes(service: ServiceDep, page: Annotated[ListPage, pages(str)]) -> VoteList:
    """List the votes: one of each class, and one by hands."""
    return VoteList(votes=await service.votes.all(page))


@router.get("/votes/{vote_id}")
async def get_vote(vote_id: str, service: ServiceDep) -> Vote:
    """Return a vote; until it is revealed only how many have voted."""
    return await service.votes.get(vote_id)


@router.post("/votes/{vote_id}/close", dependencies=[RateLimited])
async def close_vote(vote_id: str, service: ServiceDep) -> Vote:
    """Close a vote, which then takes no more answers."""
    return await service.votes.move(vote_id, "closed")


@router.post("/votes/{vote_id}/reveal", dependencies=[RateLimited])
async def reveal_vote(vote_id: str, service: ServiceDep) -> Vote:
    """Close a vote and show the counts."""
    return await service.votes.move(vote_id, "revealed")


@router.put("/votes/{vote_id}/hands", dependencies=[RateLimited])
async def count_hands(vote_id: str, body: Hands, service: ServiceDep) -> Vote:
    """Store the numbers of hands that were counted in the room."""
    return await service.votes.count_hands(vote_id, body.counts)


@router.delete("/votes/{vote_id}", status_code=204, dependencies=[RateLimited])
async def remove_vote(vote_id: str, service: ServiceDep) -> None:
    """Take a vote back; its ballots are gone."""
    await service.votes.remove(vote_id)


@router.put("/me/vote", dependencies=[RateLimited])
async def cast(body: NewBallot, person: PersonDep, service: ServiceDep) -> OpenVote | None:
    """Answer the vote of one's class, or change one's answer."""
    if person.role != "student":
        raise ApiError(403, "forbidden", "only a student of a class votes")
    return await service.votes.cast(person, body.vote, Ballot(answer=body.answer, at_ms=body.at_ms))
