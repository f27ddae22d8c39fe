"""A campaign from the command line: a folder with the table of results, and the report."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow.csv
import pyarrow.parquet as pq
from sqlalchemy.exc import DBAPIError

from core.errors import InputError
from core.nesting import read_toml
from scenarios.campaign.campaign import Campaign, Stopped
from scenarios.campaign.cluster import check_address
from scenarios.campaign.outcome import Outcome
from scenarios.campaign.sweep import Sweep
from scenarios.campaign.tally import tally
from scenarios.report.campaign import campaign_report, results_table
from scenarios.report.html import as_toml
from scenarios.report.traces import write_json, write_text
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


@dataclass(frozen=True)
class Ended:
    """How a campaign ended."""

    done: int
    total: int
    failed: int
    warnings: list[str]
    folder: Path


def read_sweep(path: Path) -> Sweep:
    """Read a campaign file; a scenario named by a path is looked for beside it.

    Raises
    ------
    InputError
        When a file cannot be read or its content is wrong.
    """
    document = _toml(path, "sweep")
    source = document.get("scenario")
    if isinstance(source, str) and source.endswith(".toml"):
        document["scenario"] = _toml(path.parent / source, "scenario")
    return Sweep.load(document)


def _toml(path: Path, field: str) -> dict[str, Any]:
    try:
        return read_toml(path.read_text("utf-8"), field, f"TOML in {path}")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}", field) from None
    except UnicodeDecodeError:
        raise InputError(f"{path} is not UTF-8 text", field) from None


def carry_out(
    sweep: Sweep,
    folder: Path,
    database_url: str,
    resume: bool,
    workers: int,
    scheduler: str,
    on_progress: Callable[[int, int], None],
) -> Ended:
    """Run the missing runs of a campaign and write its results.

    Raises
    ------
    InputError
        When the folder holds another campaign, or one that is not to be gone on with, or cannot be written; and when
        the address of the scheduler is none. Nothing is written then.
    Stopped
        When no worker computes any more, or nothing can be written; the table has the runs that are done.
    """
    if scheduler:
        check_address(scheduler)
    place, named = folder / TABLE, folder / CAMPAIGN
    if any(path.exists() for path in (place, named, folder / REPORT)) and not resume:
        text = f"{folder} holds a campaign already"
        raise InputError(text, "--out", "--resume goes on with it; or choose another folder")
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
    campaign = Campaign(sweep, results, workers=workers, scheduler=scheduler, on_progress=on_progress)
    try:
        database.migrate()
        write_text(named, as_toml({**sweep.document, "id": sweep.head.id}))
        try:
            campaign.run()
        finally:
            failed, warnings = write(sweep, results, folder)
    except DBAPIError as error:
        text = f"the database cannot be used: {reason_of(error)}"
        raise Stopped(f"{text}; {campaign.done} of {campaign.total} runs are done") from None
    except OSError as error:
        text = f"cannot write to {folder}: {error.strerror}"
        raise Stopped(f"{text}; {campaign.done} of {campaign.total} runs are done") from None
    finally:
        database.close()
        held.close()
    return Ended(campaign.done, campaign.total, failed, warnings, folder)


def write(sweep: Sweep, results: Results, folder: Path) -> tuple[int, list[str]]:
    """Write report and tables, each under a temporary name first.

    Returns
    -------
    int
        How many runs could not be carried out.
    list of str
        What the others warn of, once each.
    """
    keys = list(dict.fromkeys(key for key, _, _ in sweep.runs()))
    outcomes = {key: Outcome.model_validate_json(text) for key, text in results.outcomes(keys)}
    points = tally(sweep, outcomes)
    table = results_table(sweep, outcomes)
    write_json(folder / POINTS, [point.model_dump() for point in points])
    for name, put in (
        (REPORT, lambda path: path.write_text(campaign_report(sweep, points), "utf-8")),
        (RUNS_PARQUET, lambda path: pq.write_table(table, path, compression="zstd")),
        (RUNS_CSV, lambda path: pyarrow.csv.write_csv(table, path)),
    ):
        part = folder / f"{name}.part"
        put(part)
        part.rename(folder / name)
    told = dict.fromkeys(text for outcome in outcomes.values() for text in outcome.warnings)
    return sum(bool(outcome.error) for outcome in outcomes.values()), list(told)
