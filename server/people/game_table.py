"""The table of games: who handed in what at which seed, and what it earned."""

from __future__ import annotations

import secrets
from datetime import datetime
from typing import Any

from pydantic import BaseModel, Field
from sqlalchemy import delete, select
from sqlalchemy.orm import Session

from scenarios.games.game import Outcome
from server.people.person import Person
from server.store.base import now
from server.store.database import Database
from server.store.people import GameAttemptRow

MOST_OF_ONE = 200
"""Attempts kept of one person; the oldest are forgotten."""
MOST_SHOWN = 100
"""Lines of a table."""


class Attempt(BaseModel):
    """What somebody handed in, and what came of it."""

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
    """What somebody did at a game and a seed."""

    attempts: list[Attempt] = Field(description="Oldest first")
    looked: bool = Field(description="Whether what was hidden has been shown")


class GameTable:
    """All attempts at games.

    Parameters
    ----------
    database : Database
        Where they are kept.
    """

    def __init__(self, database: Database) -> None:
        self._database = database

    async def turns(self, person: Person, game: str, seed: int) -> Turns:
        """Return what somebody did at a game and a seed."""
        query = _of_game(game, seed).where(GameAttemptRow.person_id == person.id).order_by(GameAttemptRow.at)
        rows = await self._rows(query)
        return Turns(
            attempts=[_attempt(row) for row in rows if row.points is not None],
            looked=any(row.points is None for row in rows),
        )

    async def lines(self, class_id: str, game: str, seed: int, person: Person, tells: bool) -> list[Standing]:
        """Return the table of a class, or of somebody alone: most points first, of the same the earlier first.

        Parameters
        ----------
        class_id : str
            Empty for the table of those who are in no class.
        person : Person
            Who asks: own lines say what was handed in.
        tells : bool
            Whether the lines of others say it too.
        """
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
                handed_in=row.attempt["handed_in"] if tells or row.person_id == person.id else None,
            )
            for row in await self._rows(query.order_by(*order))
        ]

    async def add(self, person: Person, game: str, seed: int, handed: dict[str, Any], outcome: Outcome) -> Attempt:
        """Keep an attempt."""
        row = _row(person, game, seed)
        row.points, row.attempt = outcome.points, {"handed_in": handed, "outcome": outcome.model_dump()}
        await self._database.run(lambda session: _keep(session, row))
        return _attempt(row)

    async def looked(self, person: Person, game: str, seed: int) -> None:
        """Keep that somebody was shown what is hidden."""
        row = _row(person, game, seed)
        await self._database.run(lambda session: _keep(session, row))

    async def forget(self, class_id: str = "", person_id: str = "") -> None:
        """Forget the attempts of a class that has ended, or of a student who has gone."""
        column, value = (GameAttemptRow.class_id, class_id) if class_id else (GameAttemptRow.person_id, person_id)
        await self._database.run(lambda session: session.execute(delete(GameAttemptRow).where(column == value)))

    async def _rows(self, query: Any) -> list[GameAttemptRow]:
        return await self._database.run(lambda session: list(session.scalars(query)))


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


def _keep(session: Session, row: GameAttemptRow) -> None:
    """Add a row; of the same person the oldest are forgotten."""
    session.add(row)
    session.flush()
    mine = GameAttemptRow.person_id == row.person_id
    newest = select(GameAttemptRow.id).where(mine).order_by(GameAttemptRow.at.desc()).limit(MOST_OF_ONE)
    session.execute(delete(GameAttemptRow).where(mine, GameAttemptRow.id.not_in(newest)))
