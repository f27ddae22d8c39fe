"""Votes: students predict, ballots are secret, then the teacher reveals the counts."""

from __future__ import annotations

import secrets
from collections.abc import Callable
from typing import Any, Literal

from pydantic import BaseModel, Field
from sqlalchemy import delete, func, select
from sqlalchemy.orm import Session

from scenarios.lecture import Span
from server.errors import ApiError, not_found
from server.paging import ListPage
from server.security.person import Person
from server.store.change import Change
from server.store.database import Database
from server.store.people import BallotRow, VoteRow

State = Literal["open", "closed", "revealed"]


class Asked(BaseModel):
    """The question of a vote."""

    text: str
    answers: list[str] = Field(description="Names of hypotheses where lanes are asked for")
    diagnoser: str = Field(description="Whose lanes are the answers; empty where they are plain words")
    when: Span | None = Field(description="Device time within which a moment is guessed, too")


class Result(BaseModel):
    """The count of one answer; without any name."""

    count: int
    at_ms: list[float] = Field(description="The moments guessed with it, in order")


class Vote(BaseModel):
    """A vote as the teacher sees it: before it is revealed only how many have voted."""

    id: str
    class_id: str | None
    question: Asked
    state: State
    voted: int
    results: list[Result] | None = Field(description="For each answer; null until it is revealed")
    right: str | None = Field(description="The right answer; null until it is revealed")


class Ballot(BaseModel):
    """The answer of a student."""

    answer: int
    at_ms: float | None


class OpenVote(BaseModel):
    """A vote as a student sees it."""

    id: str
    question: Asked
    state: State
    mine: Ballot | None = Field(description="The student's own answer, which can be changed until the vote is closed")
    results: list[Result] | None = Field(description="Null until it is revealed")
    right: str | None


class Votes:
    """The votes of this server: one of each class, and one by hands in the room.

    Parameters
    ----------
    database : Database
        Where they are kept.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    async def open(self, class_id: str | None, question: Asked, right: str) -> Vote:
        """Ask a class, or the room; the vote before, which is not open any more, is forgotten.

        Raises
        ------
        ApiError
            If another vote of the class is open.
        """

        def opened(session: Session) -> VoteRow:
            before = _of_class(session, class_id)
            if before is not None and before.state == "open":
                raise ApiError(409, "conflict", "a vote is open already", hint="reveal it, or take it back")
            if before is not None:
                _forget(session, before.id)
            row = VoteRow(
                id=secrets.token_hex(8),
                class_id=class_id,
                question={**question.model_dump(), "right": right},
                state="open",
                hands=[0] * len(question.answers),
            )
            session.add(row)
            session.flush()
            return row

        return await self._shown(opened)

    async def all(self, page: ListPage) -> list[Vote]:
        """List the votes."""
        query = page.chosen(select(VoteRow), VoteRow.id)
        found = await self._database.run(lambda session: [_vote(session, row) for row in session.scalars(query)])
        return page.rows(found, lambda vote: (vote.id,))

    async def get(self, vote_id: str) -> Vote:
        """Return a vote."""
        return await self._shown(lambda session: _row(session, vote_id))

    async def move(self, vote_id: str, state: State) -> Vote:
        """Close a vote, or reveal it; a revealed vote stays revealed."""

        def moved(session: Session) -> VoteRow:
            row = _row(session, vote_id)
            row.state = row.state if row.state == "revealed" else state
            return row

        return await self._shown(moved)

    async def count_hands(self, vote_id: str, counts: list[int]) -> Vote:
        """Take the hands that were raised in the room, for each answer."""

        def counted(session: Session) -> VoteRow:
            row = _row(session, vote_id)
            if row.class_id is not None:
                raise ApiError(409, "conflict", "the students of a class vote themselves")
            if len(counts) != len(row.hands):
                text = f"needs one number for each of the {len(row.hands)} answers, got {len(counts)}"
                raise ApiError(422, "invalid", text, "counts")
            row.hands = counts
            return row

        return await self._shown(counted)

    async def remove(self, vote_id: str) -> None:
        """Take a vote back; its ballots are gone."""

        def removed(session: Session) -> None:
            _forget(session, _row(session, vote_id).id)

        await self._database.run(removed)

    async def of(self, person: Person) -> OpenVote | None:
        """Return the vote of a student's class, with the student's own answer only."""
        return await self._database.run(lambda session: _open_vote(session, person))

    async def cast(self, person: Person, vote_id: str, ballot: Ballot) -> OpenVote | None:
        """Take a student's answer in place of an earlier one; return the vote with it.

        Raises
        ------
        ApiError
            If the vote is not of the student's class, not open, or has no such answer or moment.
        """

        def cast(session: Session) -> OpenVote | None:
            row = session.get(VoteRow, vote_id[:32])
            if row is None or not person.class_id or row.class_id != person.class_id:
                raise not_found("vote", vote_id)
            if row.state != "open":
                raise ApiError(409, "conflict", "the vote is closed")
            answers, when = row.question["answers"], row.question["when"]
            if not 0 <= ballot.answer < len(answers):
                raise ApiError(422, "invalid", f"must be from 0 to {len(answers) - 1}", "answer")
            if (ballot.at_ms is None) != (when is None):
                raise ApiError(422, "invalid", "is asked for" if when else "is not asked for", "at_ms")
            if when is not None and not when["from_ms"] <= (ballot.at_ms or 0.0) <= when["until_ms"]:
                raise ApiError(422, "invalid", f"must be from {when['from_ms']:g} to {when['until_ms']:g}", "at_ms")
            session.merge(BallotRow(vote_id=row.id, person_id=person.id, **ballot.model_dump()))
            session.flush()
            return _open_vote(session, person)

        return await self._database.run(cast)

    def forgetting(self, class_id: str = "", person_id: str = "") -> Change:
        """Forget the vote of a class that ends, or the ballots of a student who goes."""

        def forgotten(session: Session) -> None:
            if person_id:
                session.execute(delete(BallotRow).where(BallotRow.person_id == person_id))
            if class_id and (row := _of_class(session, class_id)) is not None:
                _forget(session, row.id)

        return Change(forgotten)

    async def _shown(self, work: Callable[[Session], VoteRow]) -> Vote:
        """Do something to a vote, and describe it."""
        return await self._database.run(lambda session: _vote(session, work(session)))


def _row(session: Session, vote_id: str) -> VoteRow:
    """Return the row of a vote, or refuse with 404."""
    row = session.get(VoteRow, vote_id[:32])
    if row is None:
        raise not_found("vote", vote_id)
    return row


def _of_class(session: Session, class_id: str | None) -> VoteRow | None:
    """Return the vote of a class, or that by hands."""
    return session.scalars(select(VoteRow).where(VoteRow.class_id == class_id)).first()


def _forget(session: Session, vote_id: str) -> None:
    """Delete a vote and its ballots."""
    session.execute(delete(BallotRow).where(BallotRow.vote_id == vote_id))
    session.execute(delete(VoteRow).where(VoteRow.id == vote_id))


def _open_vote(session: Session, person: Person) -> OpenVote | None:
    """Describe the vote of a student's class to the student."""
    row = _of_class(session, person.class_id) if person.class_id else None
    if row is None:
        return None
    mine = session.get(BallotRow, (row.id, person.id))
    vote = _vote(session, row)
    return OpenVote(
        **vote.model_dump(include={"id", "question", "state", "results", "right"}),
        mine=Ballot(answer=mine.answer, at_ms=mine.at_ms) if mine is not None else None,
    )


def _vote(session: Session, row: VoteRow) -> Vote:
    """Describe a vote; the answers are left out until it is revealed."""
    of_vote = BallotRow.vote_id == row.id
    question: dict[str, Any] = {name: value for name, value in row.question.items() if name != "right"}
    results = None
    if row.state == "revealed":
        said = [Result(count=count, at_ms=[]) for count in row.hands]
        for ballot in session.scalars(select(BallotRow).where(of_vote).order_by(BallotRow.at_ms)):
            said[ballot.answer].count += 1
            if ballot.at_ms is not None:
                said[ballot.answer].at_ms.append(ballot.at_ms)
        results = said
    voted = session.scalar(select(func.count()).select_from(BallotRow).where(of_vote)) or 0
    return Vote(
        id=row.id,
        class_id=row.class_id,
        question=Asked.model_validate(question),
        state=row.state,
        voted=voted + sum(row.hands),
        results=results,
        right=(row.question["right"] or None) if results is not None else None,
    )
