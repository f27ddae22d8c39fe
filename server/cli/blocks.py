"""The command that lists the blocks of the catalogue."""

from __future__ import annotations

from typing import Annotated

import typer

from core.cards import BlockCard
from core.format import format_short, unit_text
from core.registry import catalog
from server.cli.terminal import JsonOption, plainly, say, say_json


@plainly
def blocks(
    family: Annotated[str | None, typer.Argument(help="Only this family.")] = None,
    as_json: JsonOption = False,
) -> None:
    """List every block: parameters with unit, range, default, meaning, equations."""
    cards = catalog(family)
    if as_json:
        say_json([card.model_dump() for card in cards])
        return
    for card in cards:
        _show(card)
        say()


def _show(card: BlockCard) -> None:
    """Print a block for people."""
    say(f"{card.family}/{card.name}: {card.title}")
    say(f"  {card.summary}")
    for weakness in card.weaknesses:
        say(f"  Known weakness: {weakness}")
    for equation in card.equations:
        say(f"  {equation.label}: {equation.latex}" + (f"   [{equation.source}]" if equation.source else ""))
    for entry in card.parameters:
        bounds = (entry.minimum, entry.maximum)
        limits = " .. ".join("" if bound is None else format_short(bound, "", 6) for bound in bounds)
        live = "live" if entry.live else "at reset"
        allowed = (
            f" one of {', '.join(entry.choices)}" if entry.choices else f" [{limits}]" if limits.strip(" .") else ""
        )
        default = (
            "auto" if entry.default is None else entry.default if not isinstance(entry.default, list | dict) else "..."
        )
        say(f"    {entry.name} = {default} {unit_text(entry.unit)}{allowed} ({live}): {entry.meaning}")
