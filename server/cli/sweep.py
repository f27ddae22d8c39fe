"""A campaign from the command line: a folder with the table of results, and the report."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any, BinaryIO

from sqlalchemy.exc import DBAPIError

from core.errors import InputError
from core.nesting import read_toml
from scenarios.campaign.campaign import Campaign, Stopped
from scenarios.campaign.check import check
from scenarios.campaign.executor import LOST, Processes
from scenarios.campaign.parquet import ParquetParts, write_runs
from scenarios.campaign.point_table import read_point_table
from scenarios.campaign.survey import Survey, listed
from scenarios.campaign.sweep import Sweep
from scenarios.library import get
from scenarios.own import with_units
from scenarios.reading import read_text, schema_line
from scenarios.report.campaign import surveyed_report
from scenarios.report.html import as_toml
from scenarios.report.traces import write_text
from server.store.database import Database, reason_of
from server.store.lock import lock
from server.store.results import Results

TABLE, CAMPAIGN, REPORT, POINTS, RUNS_PARQUET, RUNS_CSV = (
    "campaign.sqlite3",
    "campaign.toml",
    "report.html",
    "points.json",
    "runs.parquet",
    "runs.csv",
)
PARTS = "runs"
"""Folder of the Parquet files that grow while the campaign runs."""
MOST_LISTED = 20_000
"""Points whose tallies are written as JSON, each up to 10 kB; the tables have more."""
FEW_LISTED, PIECES = 750, 8
"""Points that are listed at once; more are listed in pieces, none smaller, by the processes."""


@dataclass(frozen=True)
class CampaignEnd:
    """How a campaign ended."""

    done: int
    total: int
    failed: int
    warnings: list[str]
    folder: Path


def read_sweep(path: Path, units: Iterable[Path] = ()) -> Sweep:
    """Read a campaign file; a scenario named by a path is relative to it, and gets units from files.

    Raises
    ------
    InputError
        When a file cannot be read or its content is wrong.
    """
    document = with_table(_toml(path, "sweep"), path.parent)
    source = document.get("scenario")
    if isinstance(source, str) and source.endswith(".toml"):
        document["scenario"] = _toml(path.parent / source, "scenario")
    if units:
        base = document.get("scenario")
        document["scenario"] = with_units(get(base).document if isinstance(base, str) else base or {}, units)
    return checked(document)


def with_table(document: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return the document of a campaign with the rows of the file that its points name, relative to a folder.

    Raises
    ------
    InputError
        When the file cannot be read, or the document has other rows too.
    """
    points = document.get("points")
    if not isinstance(points, dict) or not isinstance(table := points.get("table"), str):
        return document
    if len(points) > 1:
        raise InputError("give a table, or paths and rows, not both", "points")
    return {**document, "points": read_point_table(folder / table)}


def checked(document: dict[str, Any]) -> Sweep:
    """Return the campaign of a document, once its points and its length are checked.

    Raises
    ------
    InputError
        When its content is wrong.
    """
    sweep = Sweep(document)
    check(sweep)
    return sweep


def _toml(path: Path, field: str) -> dict[str, Any]:
    return read_toml(read_text(path, field), field, f"TOML in {path}")


def carry_out(
    sweep: Sweep,
    folder: Path,
    database_url: str,
    resume: bool,
    workers: int,
    scheduler: str,
    on_progress: Callable[[int, int], None],
) -> CampaignEnd:
    """Run the missing runs of a campaign and write its results.

    Raises
    ------
    InputError
        When the folder holds another campaign, or a campaign that must not be continued, or cannot be written; and when
        the address of the scheduler is invalid. Nothing is written then.
    Stopped
        When no worker computes any more, or nothing can be written; the table has the runs that are done.
    """
    if scheduler:
        from scenarios.campaign.cluster import check_address

        check_address(scheduler)
    place, named = folder / TABLE, folder / CAMPAIGN
    if any(path.exists() for path in (place, named, folder / REPORT)) and not resume:
        text = f"{folder} holds a campaign already"
        raise InputError(text, "--out", "--resume continues it; or choose another folder")
    held = _toml(named, "--out").get("id") if named.exists() else sweep.head.id
    if held != sweep.head.id:
        raise InputError(f"{folder} holds the campaign {held}, not {sweep.head.id}", "--out", "choose another folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        held = lock(folder, "--out")
    except OSError as error:
        raise InputError(f"cannot write to {folder}: {error.strerror}", "--out") from None
    database = Database(database_url or place)
    results = Results(database)
    parts, processes = ParquetParts(sweep, folder / PARTS), Processes(workers)

    def follow(done: int, total: int) -> None:
        parts.follow(done, results.outcomes)
        on_progress(done, total)

    own = None if scheduler else processes
    campaign = Campaign(sweep, results, scheduler=scheduler, processes=own, on_progress=follow)
    try:
        database.migrate()
        write_text(named, schema_line("campaign") + as_toml({**sweep.document, "id": sweep.head.id}))
        try:
            campaign.run()
        finally:
            parts.keep_up(results.outcomes, to_end=True)
            failed, warnings = write(sweep, parts, folder, processes)
    except DBAPIError as error:
        text = f"the database cannot be used: {reason_of(error)}"
        raise Stopped(f"{text}; {campaign.done} of {campaign.total} runs are done") from None
    except OSError as error:
        text = f"cannot write to {folder}: {error.strerror}"
        raise Stopped(f"{text}; {campaign.done} of {campaign.total} runs are done") from None
    finally:
        processes.shutdown()
        database.close()
        held.close()
    return CampaignEnd(campaign.done, campaign.total, failed, warnings, folder)


def write(sweep: Sweep, parts: ParquetParts, folder: Path, processes: Processes) -> tuple[int, list[str]]:
    """Write report and tables, each under a temporary name first; many points are listed by the processes meanwhile.

    Returns
    -------
    int
        How many runs could not be carried out.
    list of str
        The warnings of the others, once each.
    """
    survey, count = Survey(sweep, parts), len(sweep.points)
    size = max(FEW_LISTED, -(-count // PIECES))
    pieces = [range(first, min(first + size, count)) for first in range(0, count, size)]
    listing: list[Future[bytes]] = []
    with contextlib.suppress(*LOST):
        while FEW_LISTED < count <= MOST_LISTED and len(listing) < len(pieces):
            listing.append(processes.submit(listed, sweep.document, folder / PARTS, pieces[len(listing)]))

    def list_points(file: BinaryIO) -> None:
        for piece, elsewhere in zip_longest(pieces, listing):
            text = None
            with contextlib.suppress(*LOST):
                text = elsewhere.result() if elsewhere is not None else None
            file.write((b",\n" if file.tell() else b"[\n") + (text or survey.listed(piece)))
        file.write(b"\n]\n")

    files: dict[str, Callable[[BinaryIO], object]] = {
        REPORT: lambda file: file.write(surveyed_report(sweep, survey).encode()),
        RUNS_PARQUET: lambda file: write_runs(parts, file, kind="parquet"),
        RUNS_CSV: lambda file: write_runs(parts, file, kind="csv"),
    }
    if count <= MOST_LISTED:
        files[POINTS] = list_points
    for name, put in files.items():
        part = folder / f"{name}.part"
        with part.open("wb") as file:
            put(file)
        part.rename(folder / name)
    return survey.failed(), survey.warnings()
