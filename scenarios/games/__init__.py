"""Games with the bank of hypotheses: the hidden values of a seed, the answer, and the rule of the points; pure."""

from __future__ import annotations

from typing import Any

from core.errors import unknown
from scenarios.games.be_the_filter import BeTheFilter
from scenarios.games.fool_the_bank import FoolTheBank
from scenarios.games.game import Game, Outcome

GAMES: dict[str, Game[Any]] = {game.id: game for game in (BeTheFilter(), FoolTheBank())}
"""The games by their ids."""


def game_of(name: str) -> Game[Any]:
    """Return a game.

    Raises
    ------
    InputError
        When there is none of that id.
    """
    if name not in GAMES:
        raise unknown("game", name, GAMES, "game")
    return GAMES[name]


def judged(name: str, seed: int, values: dict[str, Any]) -> Outcome:
    """Return the points of an answer, for a process of its own."""
    game = game_of(name)
    return game.judge(seed, game.read(seed, values))
