"""The table of games: player, seed, answer and points."""

from __future__ import annotations

import secrets
from datetime import datetime
from typing import Any

from pydantic import BaseModel, Field
from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from scenarios.games.game import Outcome
from server.security.person import Person
from server.store.base import now
from server.store.change import Change
from server.store.database import Database
from server.store.people import GameAttemptRow

MOST_OF_ONE = 200
"""Attempts kept of one person; the oldest are forgotten."""
MOST_SHOWN = 100
"""Lines of a table."""


class Attempt(BaseModel):
    """An answer of a player, and its result."""

    id: str
    handed_in: dict[str, float | str]
    outcome: Outcome
    at: datetime


class Standing(BaseModel):
    """An attempt in the table."""

    id: str
    name: str
    mine: bool
    points: float
    at: datetime
    handed_in: dict[str, float | str] | None = Field(
        description="Null while the caller may still hand in: it is secret"
    )


class Turns(BaseModel):
    """The attempts of a player at a game and a seed."""

    attempts: list[Attempt] = Field(description="Oldest first")
    looked: bool = Field(description="Whether the hidden values have been shown")


class GameTable:
    """All attempts at games.

    Parameters
    ----------
    database : Database
        Where they are kept.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    async def of(self, person: Person, game: str, seed: int) -> tuple[Turns, list[Standing]]:
        """Return the attempts of a person at a game and a seed, and the table of the class."""
        return await self._database.run(lambda session: _seen(session, person, game, seed))

    async def of_class(self, class_id: str, game: str, seed: int, teacher: Person) -> list[Standing]:
        """Return the whole table of a class."""
        return await self._database.run(lambda session: _lines(session, class_id, game, seed, teacher))

    async def add(
        self, person: Person, game: str, seed: int, handed: dict[str, Any], outcome: Outcome
    ) -> tuple[Turns, list[Standing]]:
        """Keep an attempt; return attempts and table with it."""
        row = _row(person, game, seed)
        row.points, row.attempt = outcome.points, {"handed_in": handed, "outcome": outcome.model_dump()}
        return await self._database.run(lambda session: _keep(session, row, person))

    async def looked(self, person: Person, game: str, seed: int) -> tuple[Turns, list[Standing]]:
        """Keep that a person has seen the hidden facts; return attempts and table."""
        row = _row(person, game, seed)
        return await self._database.run(lambda session: _keep(session, row, person))

    def forgetting(self, class_id: str = "", person_id: str = "") -> Change:
        """Forget the attempts of a class that ends, or of a student who goes."""
        column, value = (GameAttemptRow.class_id, class_id) if class_id else (GameAttemptRow.person_id, person_id)
        return Change(lambda session: session.execute(delete(GameAttemptRow).where(column == value)))


def _seen(session: Session, person: Person, game: str, seed: int) -> tuple[Turns, list[Standing]]:
    query = _of_game(game, seed).where(GameAttemptRow.person_id == person.id).order_by(GameAttemptRow.at)
    rows = list(session.scalars(query))
    attempts = [_attempt(row) for row in rows if row.points is not None]
    turns = Turns(attempts=attempts, looked=any(row.points is None for row in rows))
    return turns, _lines(session, person.class_id, game, seed, person)


def _lines(session: Session, class_id: str, game: str, seed: int, person: Person) -> list[Standing]:
    """Return the table: most points first, of the same the earlier first."""
    query = _of_game(game, seed).where(GameAttemptRow.class_id == (class_id or None))
    query = query.where(GameAttemptRow.points.is_not(None)).limit(MOST_SHOWN)
    order = GameAttemptRow.points.desc(), GameAttemptRow.at, GameAttemptRow.id
    return [
        Standing(
            id=row.id,
            name=row.name,
            mine=row.person_id == person.id,
            points=row.points or 0.0,
            at=row.at,
            handed_in=row.attempt["handed_in"],
        )
        for row in session.scalars(query.order_by(*order))
    ]


def _of_game(game: str, seed: int) -> Any:
    return select(GameAttemptRow).where(GameAttemptRow.game == game, GameAttemptRow.seed == seed)


def _row(person: Person, game: str, seed: int) -> GameAttemptRow:
    return GameAttemptRow(
        id=secrets.token_hex(8),
        class_id=person.class_id or None,
        person_id=person.id,
        name=person.name,
        game=game,
        seed=seed,
        points=None,
        at=now(),
        attempt={},
    )


def _attempt(row: GameAttemptRow) -> Attempt:
    return Attempt(id=row.id, at=row.at, **row.attempt)


def _keep(session: Session, row: GameAttemptRow, person: Person) -> tuple[Turns, list[Standing]]:
    """Add a row; of the same person the oldest are forgotten."""
    session.add(row)
    session.flush()
    mine = GameAttemptRow.person_id == row.person_id
    newest = select(GameAttemptRow.id).where(mine).order_by(GameAttemptRow.at.desc()).limit(MOST_OF_ONE)
    session.execute(delete(GameAttemptRow).where(mine, GameAttemptRow.id.not_in(newest)))
    return _seen(session, person, row.game, row.seed)
