"""The commands that export a bench for other simulators, or as a file, a folder or a package."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from core.errors import InputError
from scenarios.edit import parse_assignment, with_values
from server.cli.terminal import AssignOption, load, plainly, say

if TYPE_CHECKING:
    from scenarios.in_a_file.bench_file import BenchFile
    from scenarios.in_a_file.html import BuiltPage
    from scenarios.schema import Scenario

WAYS = "--html FILE, --static DIR, --scorm FILE or --gallery DIR"


@plainly
def fmu(
    scenario: Annotated[str, typer.Argument(help="Library id or file.")],
    assign: AssignOption = None,
    out: Annotated[Path, typer.Option(metavar="FILE", help="File of the FMU.")] = Path("device.fmu"),
) -> None:
    """Write a bench without its controllers as an FMU of FMI 3: voltages and severities in, signals out."""
    from scenarios.fmu.fmu import export
    from server.version import VERSION

    chosen = with_values(load(scenario), dict(parse_assignment(text) for text in assign or []))
    with writing(out, "--out"):
        made = export(chosen, out, VERSION)
    say(f"{out}, a step of {made.step_s:g} s, for {made.platform}")
    for reason in made.left_out:
        say(f"  without {reason}")


@contextmanager
def writing(path: Path, option: str) -> Iterator[None]:
    """Refuse in one line a file that the system does not let be written."""
    try:
        yield
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}", option) from None


@plainly
def export(
    scenario: Annotated[str, typer.Argument(help="Library id or file; for --gallery a pattern of ids.")] = "",
    html: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the bench into one HTML file.")] = None,
    scorm: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write a package of SCORM 1.2 for a course.")
    ] = None,
    sheet: Annotated[
        str | None,
        typer.Option("--sheet", metavar="ID", help="With --scorm: a lab sheet, by its id or file, with its bench."),
    ] = None,
    gallery: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write the library as live pages with an index, for any host.")
    ] = None,
    static: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write the whole page with the bench into a folder for a static host."),
    ] = None,
    assign: AssignOption = None,
) -> None:
    """Write a scenario as a live bench that any browser runs without a server, with the same digest."""
    if sum(way is not None for way in (html, scorm, gallery, static)) != 1:
        raise InputError("name one thing to write", "--html", WAYS)
    if sheet is not None and scorm is None:
        raise InputError("goes with --scorm", "--sheet")
    if gallery is not None:
        _gallery(gallery, scenario or "*")
    elif sheet is not None and scorm is not None:
        if scenario or assign:
            raise InputError("goes without a scenario: the sheet names its bench", "--sheet")
        _sheet(scorm, sheet)
    elif not scenario:
        raise InputError("name the scenario", "scenario")
    else:
        chosen = with_values(load(scenario), dict(parse_assignment(text) for text in assign or []))
        _exhibit(chosen, html, scorm, static)


def _exhibit(scenario: Scenario, html: Path | None, scorm: Path | None, static: Path | None) -> None:
    """Write a scenario: with its published run as a file or a package, or with the whole page as a folder."""
    from scenarios.in_a_file.bench_file import bench_file
    from scenarios.in_a_file.exhibit import exhibit
    from scenarios.in_a_file.scorm import package
    from server.version import VERSION

    made = bench_file(scenario)
    if static is not None:
        _static(scenario, made, static)
    else:
        text = exhibit(scenario, made, _built(), VERSION).text
        if html is not None:
            _write(html, text.encode(), "--html")
        elif scorm is not None:
            _write(scorm, package(scenario.id, made.document["title"], text), "--scorm")
    for reason in made.left_out:
        say(f"  without {reason}")


def _static(scenario: Scenario, made: BenchFile, folder: Path) -> None:
    """Write the whole page with the bench."""
    from server.api.page import DIST
    from server.cli.folder import write_folder
    from server.version import VERSION

    with writing(folder, "--static"):
        size = write_folder(scenario, made, DIST, folder, VERSION)
    say(f"{folder}, {size / 1e3:.0f} kB: put it on any static host, or serve it by python3 -m http.server")


def _sheet(scorm: Path, name: str) -> None:
    """Write a lab sheet with its bench as a package."""
    from scenarios.in_a_file.bench_file import bench_file
    from scenarios.in_a_file.html import html_of
    from scenarios.in_a_file.questions import file_sheet
    from scenarios.in_a_file.scorm import package
    from server.cli.lessons import sheet_named
    from server.version import VERSION

    sheet = sheet_named(name, "--sheet")
    asked = file_sheet(sheet)
    made, built = bench_file(asked.scenario), _built()
    title = asked.document["title"]
    _write(scorm, package(sheet.id, title, html_of(made, built, VERSION, sheet=asked.document)), "--scorm")
    say(f"  {len(asked.document['questions'])} questions. {asked.document['rest']}")


def _gallery(folder: Path, pattern: str) -> None:
    """Write the library as a folder for a static host."""
    from fnmatch import fnmatch

    from scenarios.benchmark.track import tracks
    from scenarios.in_a_file.gallery import INDEX_PAGE, page_of, write_gallery
    from scenarios.library import get, ids
    from server.version import VERSION

    names = [name for name in ids() if fnmatch(name, pattern)]
    chosen = [name for name in tracks() if fnmatch(page_of(name), pattern)]
    if not names and not chosen:
        raise InputError(f"no scenario matches {pattern!r}", "scenario")
    with writing(folder, "--gallery"):
        pages = write_gallery(folder, map(get, names), _built(), VERSION, say, chosen)
    say(f"{folder / INDEX_PAGE}, {len(pages)} pages")


def _built() -> BuiltPage:
    from scenarios.in_a_file.html import BuiltPage
    from server.api.page import DIST

    return BuiltPage.of(DIST / "in-a-file")


def _write(file: Path, content: bytes, option: str) -> None:
    with writing(file, option):
        file.write_bytes(content)
    say(f"{file}, {len(content) / 1e3:.0f} kB")
