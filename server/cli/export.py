"""The commands that export a device for other simulators, and a bench as a file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from core.errors import InputError
from scenarios.edit import parse_assignment, with_values
from scenarios.extras import require
from server.cli.terminal import AssignOption, load, plainly, say


@plainly
def fmu(
    scenario: Annotated[str, typer.Argument(help="Library id or file.")],
    assign: AssignOption = None,
    out: Annotated[Path, typer.Option(metavar="FILE", help="File of the FMU.")] = Path("device.fmu"),
) -> None:
    """Write the device of a scenario as an FMU of FMI 3: its linear plant, voltage in, displacement out."""
    chosen = with_values(load(scenario), dict(parse_assignment(text) for text in assign or []))
    require("pythonfmu3", "fmi", "fmu")
    from scenarios.outside.fmu import export

    with writing(out, "--out"):
        export(chosen, out)
    say(f"{out}, a step of {chosen.spec.dt_ms / 1e3:g} s")


@contextmanager
def writing(path: Path, option: str) -> Iterator[None]:
    """Refuse in one line a file that the system does not let be written."""
    try:
        yield
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}", option) from None


@plainly
def export(
    scenario: Annotated[str, typer.Argument(help="Library id or file.")],
    html: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the bench into one HTML file.")] = None,
    static: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Write the whole page with the bench into a folder for a static host."),
    ] = None,
    assign: AssignOption = None,
) -> None:
    """Write a scenario as a live bench in a file or a folder, which a browser runs without a server, same digest."""
    from scenarios.in_a_file.bench_file import bench_file
    from scenarios.in_a_file.html import html_of
    from server.api.page import DIST
    from server.version import VERSION

    if html is None and static is None:
        raise InputError("name the file to write", "--html", "such as --html bench.html, or --static DIR for a folder")
    chosen = with_values(load(scenario), dict(parse_assignment(text) for text in assign or []))
    made = bench_file(chosen)
    if html is not None:
        text = html_of(made, DIST / "in-a-file", VERSION)
        with writing(html, "--html"):
            html.write_text(text, "utf-8")
        say(f"{html}, {len(text.encode()) / 1e3:.0f} kB")
    if static is not None:
        from server.cli.folder import write_folder

        with writing(static, "--static"):
            size = write_folder(chosen, made, DIST, static, VERSION)
        say(f"{static}, {size / 1e3:.0f} kB: put it on any static host, or serve it by python3 -m http.server")
    for reason in made.left_out:
        say(f"  without {reason}")
