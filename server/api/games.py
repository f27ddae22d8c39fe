"""Games with the bank: list them, play at a seed, hand in, see the table; the teacher sees the table of a class."""

from __future__ import annotations

from typing import Annotated

from fastapi import Depends, Path, Query
from pydantic import BaseModel, Field

from core.cards import EquationCard, ParameterCard, equation_card, parameter_cards
from scenarios.games import GAMES
from scenarios.games.game import MOST
from server.api.bodies import AnswerBody, Body
from server.api.deps import PersonDep, RateLimited, ServiceDep
from server.api.router import Router
from server.classroom.games import ClassGame, Play
from server.errors import ApiError
from server.security.person import Person

router = Router(tags=["games"])

GameId = Annotated[str, Path(max_length=40)]
Seed = Annotated[int, Query(ge=0, le=MOST, description="Seed of the game, which differs from student to student")]


def get_player(person: PersonDep) -> Person:
    """Return the caller; refuse a watcher, because watchers have no bench of a game."""
    if person.role == "watcher":
        raise ApiError(409, "conflict", "a person who watches a bench plays no game")
    return person


PlayerDep = Annotated[Person, Depends(get_player)]


class GameCard(AnswerBody):
    """A game in a list."""

    id: str
    title: str
    summary: str
    task: str
    rule: str = Field(description="Rule of the points, in words")
    equations: list[EquationCard]
    attempts: int = Field(description="Number of answers that one person may hand in at one seed")
    hand_in: list[ParameterCard] = Field(description="Fields of the answer")
    live: list[str] = Field(description="Fields that can be set on the live bench")


class GameList(BaseModel):
    """The games."""

    games: list[GameCard]


class Begin(Body):
    """A bench of a game to begin."""

    seed: int = Field(ge=0, le=MOST)
    hand_in: dict[str, float | str] = Field(
        {}, max_length=20, description="Settings of the bank; left out: the defaults"
    )


class NewAttempt(Body):
    """Values of an answer."""

    seed: int = Field(ge=0, le=MOST)
    hand_in: dict[str, float | str] = Field(max_length=20, description="Fields of the answer; left out: the defaults")


class Look(Body):
    """A seed whose game is to be over."""

    seed: int = Field(ge=0, le=MOST)


@router.get("/games")
async def list_games() -> GameList:
    """List the games with their rules."""
    return GameList(
        games=[
            GameCard.of(
                game,
                equations=[equation_card(equation) for equation in game.equations],
                hand_in=parameter_cards(game.form),
                live=list(game.turned),
            )
            for game in GAMES.values()
        ]
    )


@router.get("/games/{game_id}")
async def get_game(game_id: GameId, service: ServiceDep, person: PlayerDep, seed: Seed = 1) -> Play:
    """Show a game at a seed: own attempts, the table, and the hidden values once the game is over."""
    return await service.games.view(person, game_id, seed)


@router.post("/games/{game_id}/begin", status_code=201, dependencies=[RateLimited])
async def begin_game(game_id: GameId, body: Begin, service: ServiceDep, person: PlayerDep) -> Play:
    """Begin the bench of a game, which replaces the earlier bench and hides the values of the game."""
    if person.role == "student":
        service.driving.check(service.people.bench_of(person), person)  # the bench before is closed with it
    begun = await service.games.begin(person, game_id, body.seed, body.hand_in)
    await service.checkpoints.write()  # the bench of a student hides them after a crash too
    return begun


@router.post("/games/{game_id}/attempts", status_code=201, dependencies=[RateLimited])
async def hand_in(game_id: GameId, body: NewAttempt, service: ServiceDep, person: PlayerDep) -> Play:
    """Hand in: the server judges it by the rule, and the last attempt of the answer has the points."""
    judged = await service.games.hand_in(person, game_id, body.seed, body.hand_in)
    points = judged.attempts[-1].outcome.points
    service.audit.add(person.name, "game", f"{game_id}, seed {body.seed}: {points:.1f} points", person.class_id)
    return judged


@router.post("/games/{game_id}/reveal", dependencies=[RateLimited])
async def reveal_game(game_id: GameId, body: Look, service: ServiceDep, person: PlayerDep) -> Play:
    """Show the hidden values of a seed; the caller cannot hand in at it any more."""
    return await service.games.look(person, game_id, body.seed)


@router.get("/classes/{class_id}/games/{game_id}")
async def get_class_game(
    class_id: str, game_id: GameId, service: ServiceDep, person: PersonDep, seed: Seed = 1
) -> ClassGame:
    """Show the table of a class with all settings handed in, and the hidden facts of each student."""
    await service.classes.row(class_id)
    return await service.games.of_class(person, class_id, game_id, seed)
