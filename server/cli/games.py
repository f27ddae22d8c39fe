"""The command for games: lists them, judges an answer, and shows the hidden values of a seed."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from core.cards import parameter_cards
from core.format import format_short
from scenarios.edit import parse_assignment
from server.cli.terminal import JsonOption, plainly, say, say_json


@plainly
def game(
    name: Annotated[
        str | None, typer.Argument(metavar="GAME", help="The game; without one, the list of all games.")
    ] = None,
    seed: Annotated[
        int, typer.Option(help="Seed of the game: the same seed gives the same game, except in a class.")
    ] = 1,
    assign: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="A value of the answer. May be repeated.")
    ] = None,
    hidden: Annotated[bool, typer.Option("--hidden", help="Show the hidden values of the seed.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Play a game headless: print the points of an answer, with the bits of the page; exit code 2: invalid input."""
    from scenarios.games import GAMES, game_of
    from scenarios.games.game import check_seed

    if name is None:
        rows = [{"id": one.id, "title": one.title, "summary": one.summary} for one in GAMES.values()]
        return say_json(rows) if as_json else say("\n".join(f"{row['id']:<16} {row['summary']}" for row in rows))
    chosen, seed = game_of(name), check_seed(seed)
    if hidden:
        facts = chosen.hidden(seed)
        told = "\n".join(f"{fact.name}: {fact.said}" for fact in facts)
        return say_json([fact.model_dump() for fact in facts]) if as_json else say(told)
    if not assign:
        document: dict[str, Any] = {
            "game": chosen.id,
            "seed": seed,
            "task": chosen.task,
            "rule": chosen.rule,
            "hand_in": [one.model_dump() for one in parameter_cards(chosen.form)],
            "kinds": [kind.model_dump() for kind in chosen.kinds(seed)],
        }
        return say_json(document) if as_json else _explain(document)
    handed = chosen.read(seed, dict(parse_assignment(text) for text in assign))
    outcome = chosen.judge(seed, handed)
    document = {"game": chosen.id, "seed": seed, "handed_in": handed.model_dump(), **outcome.model_dump()}
    return say_json(document) if as_json else say(outcome.said)


def _explain(document: dict[str, Any]) -> None:
    """Print the task, and the values of an answer."""
    say(document["task"])
    say()
    say(document["rule"])
    say()
    for one in document["hand_in"]:
        usual = one["default"] if isinstance(one["default"], str) else format_short(one["default"], one["unit"])
        say(f"  {one['name']:<20} {one['meaning']} (default {usual})")
    for kind in document["kinds"]:
        ends = [format_short(kind[end], "" if kind["unit"] == "1" else kind["unit"]) for end in ("minimum", "maximum")]
        say(f"  fault={kind['name']:<20} severity from {ends[0]} to {ends[1]}")
