"""The command that checks user units."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from core import registry
from core.board.packages import packages
from core.compile import code
from core.errors import InputError
from core.format import format_si
from scenarios.reading import read_text
from server.cli.terminal import JsonOption, plainly, say, say_json

UnitOption = Annotated[
    list[Path] | None,
    typer.Option("--unit", metavar="FILE", help="A unit of your own, with the name of its file. May be repeated."),
]


@plainly
def check(
    given: Annotated[
        list[str],
        typer.Argument(metavar="FILE", help="Units of your own, a file each; or installed packages, by name."),
    ],
    as_json: JsonOption = False,
) -> None:
    """Check your own units; exit code 0: all are usable, with the cost of a sample, 2: one is not, with its place."""
    found = [row for one in given for row in (_of_package(one) if one in packages() else [_of_file(Path(one))])]
    if as_json:
        say_json(found)
    else:
        for row in found:
            say(_line(row))
    raise typer.Exit(2 if any("error" in row for row in found) else 0)


def _of_file(file: Path) -> dict[str, Any]:
    """Return what there is to say about the unit of a file."""
    from core.own.text import UnitError
    from core.own.unit import unit
    from scenarios.speed.units import cost_ns

    try:
        one = unit(file.stem, read_text(file, "unit"))
        row = {"family": one.family, "name": one.name, "hash": one.hash, "operations": one.operations}
        return {"file": str(file), **row, "ns_per_sample": cost_ns(one.block)}
    except InputError as error:
        found = error.all if isinstance(error, UnitError) else (error,)
        return {"file": str(file), "error": error.as_dict(), "errors": [one.as_dict() for one in found]}


def _of_package(name: str) -> Iterator[dict[str, Any]]:
    """Yield what there is to say about each unit of an installed package."""
    from scenarios.speed.units import cost_ns

    for entry in packages()[name].entries:
        family = entry.group.removeprefix("combbench.")
        row = {"file": name, "family": family, "name": entry.name}
        try:
            block = registry.block(family, entry.name)
            code.address(block)
            yield {**row, "ns_per_sample": cost_ns(block)}
        except InputError as error:
            yield {**row, "error": error.as_dict()}


def _line(row: dict[str, Any]) -> str:
    """Return the text about one unit: a line, or a line for each error."""
    if "errors" in row:
        return "\n".join(f"{row['file']}: {error['message']}" for error in row["errors"])
    if "error" in row:
        error = row["error"]
        return f"{row['file']}: {error['message']}" + (f" ({error['hint']})" if error["hint"] else "")
    told = [f"{row['file']}: {row['family']}/{row['name']}"]
    if row["ns_per_sample"] is not None:
        told.append(f"{format_si(row['ns_per_sample'] * 1e-9, 's')} a sample")
    if "operations" in row:
        told.append(f"at most {row['operations']} operations")
    return ", ".join(told)
