"""The command that exports a device for other simulators."""

from __future__ import annotations

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

    try:
        export(chosen, out)
    except OSError as error:
        raise InputError(f"cannot write {out}: {error.strerror}", "--out") from None
    say(f"{out}, a step of {chosen.spec.dt_ms / 1e3:g} s")
