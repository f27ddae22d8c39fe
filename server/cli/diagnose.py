"""The command that diagnoses a record of a real device."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from core.errors import InputError
from core.format import format_short
from scenarios.records.examples import example
from server.cli.replay import BenchOption, FileArgument, MapOption, PairingOption, RateOption, read_file
from server.cli.terminal import JsonOption, load, plainly, say, say_json
from server.cli.units import UnitOption

if TYPE_CHECKING:
    from scenarios.records.diagnosis import RecordDiagnosis
    from scenarios.records.reading import ReadRecord

EXITS = {"no fault": 0, "fault": 1, "unexplained": 3, "refused": 3}


@plainly
def diagnose_file(
    file: FileArgument,
    scenario: BenchOption = "first-look",
    healthy: Annotated[
        str | None,
        typer.Option(metavar="A:B", help="The healthy stretch, samples A to before B; the first quarter without it."),
    ] = None,
    named: MapOption = None,
    rate_khz: RateOption = None,
    pairing: PairingOption = "next",
    units: UnitOption = None,
    html: Annotated[
        Path | None, typer.Option("--html", metavar="REPORT", help="Write a report here, one file.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Calibrate by a healthy stretch and diagnose; exit code 0: no fault, 1: a fault, 3: refused or unexplained."""
    from scenarios.records.diagnosis import as_document, diagnose  # scipy: most commands do without it

    read = read_file(file, named, rate_khz, pairing)
    known = None if file.exists() else example(str(file))
    first, end = (0, known.healthy) if known and healthy is None else _stretch(healthy, read.record.samples)
    found = diagnose(read.record, load(scenario, units), first, end)
    if html is not None:
        _write_report(html, found, read, file)
    if as_json:
        say_json({**as_document(found), "columns": read.columns, "notes": read.notes, "exit": EXITS[found.outcome]})
    else:
        for note in read.notes:
            say(f"note: {note}")
        say(_text(found))
    raise typer.Exit(EXITS[found.outcome])


def _write_report(path: Path, found: RecordDiagnosis, read: ReadRecord, file: Path) -> None:
    from scenarios.report.diagnosis import diagnosis_report  # templates: only reports need them
    from scenarios.report.traces import write_text

    try:
        write_text(path, diagnosis_report(found, file.name, read.columns, read.notes))
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}", "--html") from None


def _stretch(text: str | None, samples: int) -> tuple[int, int | None]:
    if text is None:
        return 0, None
    first, _, end = text.partition(":")
    try:
        return int(first or 0), int(end) if end else samples
    except ValueError:
        raise InputError(f"must be A:B, two samples, got {text!r}", "--healthy", "--healthy 0:2000") from None


def _text(found: RecordDiagnosis) -> str:
    """Return the calibration and the verdicts as lines."""
    from scenarios.records.diagnosis import UNEXPLAINED

    one = found.calibration
    lines = [f"calibrated by {one.samples} samples, half of them fitted, half of them tested:"]
    for name, unit in (
        ("mass", ""),
        ("damping", ""),
        ("stiffness", ""),
        ("offset_um", "um"),
        ("delay_samples", "samples"),
    ):
        estimate = getattr(one, name)
        low, high = estimate.interval
        over = f"{unit or 'of nominal'}, 95 % interval {low:.5g} to {high:.5g}"
        lines.append(f"  {name.removesuffix('_um').removesuffix('_samples'):<10} {estimate.value:9.5f} {over}")
    lines.append(f"  {'noise':<10} {format_short(one.noise_um, 'um')}")
    if found.refusal:
        return "\n".join([*lines, f"REFUSED: {found.refusal}"])
    lines.append(found.sentence)
    for name, verdicts in found.verdicts.items():
        shares = ", ".join(f"{word} {100.0 * share:.0f} %" for word, share in found.shares[name].items())
        lines.append(f"{name}: {shares}")
        for entry in verdicts:
            loud = "  <- no hypothesis explains this" if entry.verdict == UNEXPLAINED else ""
            lines.append(f"  {entry.first:>8} to {entry.end:>8}  {entry.verdict:<12} {entry.probability:.3f}{loud}")
    return "\n".join(lines)
