"""The commands that export a bench for other simulators, and as a file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from core.errors import InputError
from scenarios.edit import parse_assignment, with_values
from server.cli.terminal import AssignOption, load, plainly, say


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
    try:
        made = export(chosen, out, VERSION)
    except OSError as error:
        raise InputError(f"cannot write {out}: {error.strerror}", "--out") from None
    say(f"{out}, a step of {made.step_s:g} s, for {made.platform}")
    for reason in made.left_out:
        say(f"  without {reason}")


@plainly
def export(
    scenario: Annotated[str, typer.Argument(help="Library id or file.")],
    html: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the bench into one HTML file.")] = None,
    assign: AssignOption = None,
) -> None:
    """Write a scenario as a live bench in a file, which any browser runs without a server, with the same digest."""
    from scenarios.in_a_file.bench_file import bench_file
    from scenarios.in_a_file.html import html_of
    from server.api.page import DIST
    from server.version import VERSION

    if html is None:
        raise InputError("name the file to write", "--html", "such as --html bench.html")
    chosen = with_values(load(scenario), dict(parse_assignment(text) for text in assign or []))
    made = bench_file(chosen)
    text = html_of(made, DIST / "in-a-file", VERSION)
    try:
        html.write_text(text, "utf-8")
    except OSError as error:
        raise InputError(f"cannot write {html}: {error.strerror}", "--html") from None
    say(f"{html}, {len(text.encode()) / 1e3:.0f} kB")
    for reason in made.left_out:
        say(f"  without {reason}")
