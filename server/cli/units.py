"""The command that checks user units."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from core.errors import InputError
from core.format import format_si
from scenarios.reading import read_text
from server.cli.terminal import JsonOption, plainly, say, say_json

UnitOption = Annotated[
    list[Path] | None,
    typer.Option("--unit", metavar="FILE", help="A unit of your own, named after its file. May be repeated."),
]


@plainly
def check(
    files: Annotated[list[Path], typer.Argument(help="Units of your own, a file each.")],
    as_json: JsonOption = False,
) -> None:
    """Check units of your own: 0 all can be used, each with its cost per sample; 2 one cannot, with line and column."""
    from core.own.unit import unit
    from scenarios.speed.units import cost_ns

    found: list[dict[str, Any]] = []
    for file in files:
        try:
            one = unit(file.stem, read_text(file, "unit"))
            row = {"family": one.family, "name": one.name, "hash": one.hash, "operations": one.operations}
            found.append({"file": str(file), **row, "ns_per_sample": cost_ns(one)})
        except InputError as error:
            found.append({"file": str(file), "error": error.as_dict()})
    if as_json:
        say_json(found)
    else:
        for row in found:
            say(_line(row))
    raise typer.Exit(2 if any("error" in row for row in found) else 0)


def _line(row: dict[str, Any]) -> str:
    """Return the text about one unit."""
    if "error" in row:
        error = row["error"]
        return f"{row['file']}: {error['message']}" + (f" ({error['hint']})" if error["hint"] else "")
    cost = f"{format_si(row['ns_per_sample'] * 1e-9, 's')} a sample"
    return f"{row['file']}: {row['family']}/{row['name']}, {cost}, at most {row['operations']} operations"
