"""The command that prints the JSON Schemas of documents, for editors and other programs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from core.errors import InputError
from scenarios.reading import schema_file
from server.cli.terminal import plainly, say, say_json


@plainly
def schema(
    name: Annotated[
        str | None, typer.Argument(help="scenario, campaign, sheet or lecture; without it, a list.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write it here, or all of them, as NAME.schema.json.")
    ] = None,
) -> None:
    """Print the JSON Schema of a kind of document, which editors complete and check documents by."""
    from scenarios.json_schema.documents import TITLES, json_schema

    chosen = [*TITLES] if name is None else [name]
    if out is not None:
        _write(out, {one: json.dumps(json_schema(one), indent=2) for one in chosen})
    elif name is not None:
        say_json(json_schema(name))
    else:
        for one, title in TITLES.items():
            say(f"{one:<10} {title}")


def _write(folder: Path, texts: dict[str, str]) -> None:
    """Write schemas into a folder, each under the name that documents refer to."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (folder / schema_file(name)).write_text(f"{text}\n", "utf-8")
            say(str(folder / schema_file(name)))
    except OSError as error:
        raise InputError(f"cannot write to {folder}: {error.strerror}", "--out") from None
