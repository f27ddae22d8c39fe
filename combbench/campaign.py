"""Campaigns: a scenario at many points, with many seeds."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

    from scenarios.campaign.survey import Survey
    from scenarios.campaign.tally import PointTally


class CampaignResult:
    """The runs of a campaign, in a folder.

    Parameters
    ----------
    folder : Path
        It has the table of results, ``report.html``, ``runs.parquet`` and ``runs.csv``.
    survey : Survey
        The figures of the points.
    """

    def __init__(self, folder: Path, survey: Survey) -> None:
        self.folder = folder
        self._survey = survey

    @property
    def points(self) -> list[PointTally]:
        """The points of the campaign, each with its labels, and mean and spread of every figure over its seeds."""
        return self._survey.page(self._survey.order())

    @property
    def failed(self) -> int:
        """Runs that could not be carried out."""
        return self._survey.failed()

    @property
    def warnings(self) -> list[str]:
        """Warnings of the runs, each once."""
        return self._survey.warnings()

    def to_pandas(self) -> pd.DataFrame:
        """Return one row for each run: its point, seed, figures, digest and trip; needs pandas."""
        from scenarios.arrow import pq
        from server.cli.sweep import RUNS_PARQUET

        frame: pd.DataFrame = pq.read_table(self.folder / RUNS_PARQUET).to_pandas()
        return frame


def sweep(
    campaign: str | Path | dict[str, Any],
    *,
    folder: str | Path | None = None,
    resume: bool = False,
    workers: int | None = None,
) -> CampaignResult:
    """Run a campaign with processes of this machine.

    A program that calls this at its top level needs ``if __name__ == "__main__":``, as for every pool of processes.

    Parameters
    ----------
    campaign : str, Path or dict
        A campaign file, or its document: ``{"scenario": "ch5-seven-step", "seeds": {"count": 8}, "grid": {...}}``.
        Points of a design are ``{"points": {"paths": [...], "rows": [...]}}``, or ``{"points": {"table": FILE}}``.
    folder : str or Path, optional
        Where the results are kept; a temporary folder unless given.
    resume : bool
        Continue the campaign that the folder holds.
    workers : int, optional
        Processes; one for each processor unless given.

    Raises
    ------
    InputError
        For a campaign that is not valid, and a folder that cannot be used. Nothing is written then.
    """
    from scenarios.campaign.parquet import ParquetParts
    from scenarios.campaign.survey import Survey
    from server.cli.sweep import PARTS, carry_out, checked, read_sweep, with_table

    chosen = checked(with_table(campaign, Path())) if isinstance(campaign, dict) else read_sweep(Path(campaign))
    place = Path(folder) if folder is not None else Path(tempfile.mkdtemp(prefix="combbench-"))
    carry_out(chosen, place, "", resume, workers or os.cpu_count() or 1, "", lambda _done, _all: None)
    return CampaignResult(place, Survey(chosen, ParquetParts(chosen, place / PARTS)))
