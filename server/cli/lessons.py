"""The commands for teaching: lectures and lab sheets, listed and checked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from core.format import format_short, format_si
from scenarios.reading import read_text
from server.cli.terminal import JsonOption, plainly, say, say_json

if TYPE_CHECKING:
    from scenarios.sheets.sheet import Sheet


@plainly
def lectures(
    files: Annotated[
        list[Path] | None, typer.Argument(help="Your own lectures; without one, the lectures of the library.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Check lectures by running each cue; exit code 0: all claims of notes hold, 1: some do not, 2: invalid input."""
    from scenarios.lecture import Lecture
    from scenarios.lectures import lecture, lecture_ids

    chosen = (
        [Lecture.load(file.stem, read_text(file, "lecture")) for file in files]
        if files
        else [lecture(name) for name in lecture_ids()]
    )
    checked = [one.check() for one in chosen]
    if as_json:
        say_json(checked)
    else:
        for document in checked:
            say(f"{document['lecture']}: {document['title']}, {format_short(document['minutes'], 'min')}")
            for number, cue in enumerate(document["cues"], 1):
                said = [
                    f"{row['metric']} {format_si(row['measured'], '')}, expected {row['expected']}"
                    if row["measured"] is not None
                    else f"{row['metric']}: no such figure"
                    for row in cue["expectations"]
                ]
                say(
                    f"  {'ok  ' if cue['ok'] else 'MISS'} {number:>2} {cue['title']}"
                    + "".join(f"\n          {text}" for text in said)
                )
    raise typer.Exit(0 if all(cue["ok"] for document in checked for cue in document["cues"]) else 1)


def sheet_named(name: str, option: str) -> Sheet:
    """Return a sheet of the library by its id, or another sheet by its file."""
    from scenarios import sheets as library
    from scenarios.sheets.check import check

    if name in library.ids() or not Path(name).suffix:
        return library.get(name)
    return check(read_text(Path(name), option), Path(name).stem)


@plainly
def sheets(
    check: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A sheet of your own to check in their place.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """List the lab sheets and check all of them, or check one of your own; exit code 2 and one line: it is wrong."""
    from scenarios import sheets as library
    from scenarios.sheets.check import check as check_sheet

    if check is None:
        found = [library.get(name) for name in library.ids()]
    else:
        found = [check_sheet(read_text(check, "--check"), check.stem)]
    rows: list[dict[str, Any]] = [
        {"id": s.id, "title": s.head.title, "minutes": s.head.minutes, "steps": len(s.steps), "points": s.points}
        for s in found
    ]
    if as_json:
        return say_json(rows)
    for row in rows:
        points = format_short(row["points"], "")
        say(f"{row['id']:<20} {row['title']} ({row['minutes']} min, {row['steps']} steps, {points} points)")
