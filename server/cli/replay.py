"""The command that plays a record of a real device on a bench."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from core.errors import InputError
from scenarios.edit import parse_assignment, with_values
from scenarios.reading import read_bytes
from scenarios.records.examples import example
from scenarios.records.reading import MOST_BYTES, ReadRecord, read_record
from scenarios.records.shelf import RecordFolder
from scenarios.report.text import run_text
from scenarios.run import run
from scenarios.schema import Scenario
from server.cli.terminal import AssignOption, JsonOption, load, plainly, say, say_json
from server.cli.units import UnitOption


def read_file(
    file: Path, named: list[str] | None, rate_khz: float | None, pairing: Literal["next", "last"]
) -> ReadRecord:
    """Return the record in a file, or the example record of this name.

    Raises
    ------
    InputError
        When it cannot be read, or is no record.
    """
    if not file.exists() and file.name == str(file) and (known := example(file.name)) is not None:
        file = known.path
    content = read_bytes(file, "FILE", MOST_BYTES)
    return read_record(content, file.name, named=_named(named), rate_khz=rate_khz, pairing=pairing)


def _named(texts: list[str] | None) -> dict[str, str]:
    """Return the columns that were named as PART=COLUMN, several by commas."""
    found = {}
    for text in (one for given in texts or [] for one in given.split(",")):
        part, equals, column = text.partition("=")
        if not equals or not column:
            raise InputError(f"must be PART=COLUMN, got {text!r}", "--map", "--map drive=Vd,displacement=y")
        found[part.strip()] = column.strip()
    return found


FileArgument = Annotated[
    Path, typer.Argument(metavar="FILE", help="CSV, Parquet, MAT, NPZ, NetCDF or HDF5; or the name of an example.")
]
MapOption = Annotated[
    list[str] | None,
    typer.Option(
        "--map", metavar="PART=COLUMN", help="The column of time, drive, displacement or label; several by commas."
    ),
]
RateOption = Annotated[float | None, typer.Option(metavar="KHZ", help="Samples for each ms, of a file without times.")]
PairingOption = Annotated[
    Literal["next", "last"],
    typer.Option(help="The voltage of a row acts from this sample on (next), or acted until it (last)."),
]
BenchOption = Annotated[str, typer.Option("--scenario", help="The bench: library id or file.")]
NoiseOption = Annotated[float | None, typer.Option(metavar="UM", help="Noise of the displacement that filters assume.")]


@plainly
def replay(
    file: FileArgument,
    scenario: BenchOption = "first-look",
    named: MapOption = None,
    rate_khz: RateOption = None,
    pairing: PairingOption = "next",
    noise_um: NoiseOption = None,
    assign: AssignOption = None,
    units: UnitOption = None,
    as_json: JsonOption = False,
) -> None:
    """Play a record of a real device: identifiers and diagnosers of a bench look at it. No controller can drive it."""
    from scenarios.records.bench import on_record  # scipy: most commands do without it

    read = read_file(file, named, rate_khz, pairing)
    document = on_record(load(scenario, units), read.record, noise_um)
    with RecordFolder().keeping(read.record):
        bench = with_values(Scenario.load(document), dict(parse_assignment(text) for text in assign or []))
    summary = run(bench).summary()
    if as_json:
        say_json({**summary, "record": {"key": read.record.key, "columns": read.columns, "notes": read.notes}})
        return
    for part, column in read.columns.items():
        say(f"{part}: column {column}")
    for note in read.notes:
        say(f"note: {note}")
    say(run_text(summary))
