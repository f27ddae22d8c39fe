"""The command that reads an oscilloscope by SCPI and sends its shots to a server."""

from __future__ import annotations

import secrets
import time
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from core.errors import InputError
from core.nesting import read_toml
from scenarios.extras import require
from scenarios.reading import read_text
from scenarios.records.columns import Numbers
from scenarios.run import build
from server.cli.terminal import load, plainly, say

if TYPE_CHECKING:
    from scenarios.outside.oscilloscope import GeneratorCommands

GAP = 2
"""The fewest samples between two shots by their times: two shots are never taken for a single shot."""
MOST_TABLE = 1_000_000
"""Samples of the longest table for a generator."""


@plainly
def instrument(
    address: Annotated[
        str, typer.Argument(metavar="ADDRESS", help="VISA address of the oscilloscope, such as TCPIP::HOST::INSTR.")
    ],
    commands: Annotated[Path, typer.Argument(metavar="FILE", help="Its commands, in TOML: docs/your-device.md.")],
    to: Annotated[
        str, typer.Option(metavar="HOST:PORT", help="The port of the server for instruments.")
    ] = "127.0.0.1:8001",
    source: Annotated[str, typer.Option(metavar="NAME", help="Name under which the server lists it.")] = "scope",
    shots: Annotated[int | None, typer.Option(min=1, help="Shots to send; without it, until interrupted.")] = None,
    generator: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="VISA address of a generator, which gets a table first.")
    ] = None,
    excitation: Annotated[
        str, typer.Option(metavar="SCENARIO", help="Its table: the reference of a library id or file.")
    ] = "first-look",
    samples: Annotated[int, typer.Option(min=2, max=MOST_TABLE, help="Samples of the table.")] = 16_384,
    library: Annotated[str, typer.Option("--visa", help="VISA library.")] = "@py",
) -> None:
    """Read an oscilloscope by SCPI and send its shots to a server; a generator may get the reference of a scenario."""
    require("pyvisa", "instruments", "instrument")
    from scenarios.outside.oscilloscope import Oscilloscope, commands_of, opened
    from scenarios.outside.sender import LineSender
    from scenarios.records.line import LineHeader, read_header

    given = commands_of(read_toml(read_text(commands, "FILE"), "FILE"))
    scope = given.scope
    if generator is not None:
        if given.generator is None:
            raise InputError("has no table [generator]", "FILE")
        _excite(generator, library, given.generator, excitation, samples)
    header = LineHeader.model_construct(
        version=1,
        source=source,
        rate_khz=scope.rate_khz,
        pairing=scope.pairing,
        session=secrets.token_hex(8),
        shots=True,
    )
    read_header(header.model_dump_json().encode())
    sent, end_ns = 0, 0
    with ExitStack() as stack:
        oscilloscope = Oscilloscope(stack.enter_context(opened(address, library, "ADDRESS")), scope)
        sender = stack.enter_context(LineSender(to, header))
        say(f"{address} sends to {to} as {source}")
        try:
            while shots is None or sent < shots:
                began_ns = max(time.monotonic_ns(), end_ns)
                drive, displacement = oscilloscope.shot()
                sender.send(began_ns, scope.rate_khz, drive, displacement)
                sent, end_ns = sent + 1, began_ns + round((len(drive) + GAP) * 1e6 / scope.rate_khz)
        except KeyboardInterrupt:
            pass
    say(f"{sent} shots sent")


def _excite(address: str, library: str, commands: GeneratorCommands, scenario: str, samples: int) -> None:
    """Load the reference of a scenario into a generator."""
    from scenarios.outside.oscilloscope import load_table, opened

    volts, rate_khz = _reference(scenario, samples)
    with opened(address, library, "--generator") as device:
        load_table(device, commands, volts, rate_khz)
    say(f"{address} plays {samples} samples of the reference of {scenario}, at {rate_khz:g} samples for each ms")


def _reference(name: str, samples: int) -> tuple[Numbers, float]:
    """Return the first samples of the reference of a scenario, in V."""
    board = build(load(name))
    if "reference.voltage" not in board.signals.names:
        raise InputError(f"{name} has no reference in V", "--excitation")
    column, found = board.signals.index("reference.voltage"), list[Numbers]()
    while board.tick < samples:
        rows = board.advance(samples - board.tick)
        if not rows.count:
            raise InputError(f"the board of {name} trips at sample {board.tick}", "--excitation", "give fewer samples")
        found.append(rows.outputs[:, column].copy())
    return np.concatenate(found), 1.0 / board.dt_ms
