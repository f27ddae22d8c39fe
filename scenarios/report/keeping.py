"""Files kept of a run in addition to its trace: its summary, a report, a drawing, and a script that repeats it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from scenarios.report.figure import figure
from scenarios.report.run import run_report
from scenarios.report.script import script
from scenarios.report.svg import picture_file
from scenarios.report.traces import write_json, write_text
from scenarios.run import RunResult


def keep(result: RunResult, summary: dict[str, Any], seeds: list[int], stem: Path) -> None:
    """Write the files of a run, each under a temporary name first.

    Parameters
    ----------
    result : Result
        The run, of the first seed if there are several.
    summary : dict
        Its summary.
    seeds : list of int
        All its seeds.
    stem : Path
        Path of the files without their ending; the folder is created.
    """
    stem.parent.mkdir(parents=True, exist_ok=True)
    document = json.loads(json.dumps(result.scenario.document, default=str))
    write_text(stem.with_suffix(".html"), run_report(result, summary))
    write_text(stem.with_suffix(".svg"), picture_file(figure(result)))
    write_text(stem.with_suffix(".py"), script(document, seeds, summary["digest"], stem.name + ".py"))
    write_json(stem.with_suffix(".json"), summary)
