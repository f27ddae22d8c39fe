"""Headless runs: each a campaign of one point that keeps the trace, the report and the drawing of its first seed."""

from __future__ import annotations

import asyncio
import json
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from core.own.admission import kept
from scenarios.campaign.campaign import Campaign
from scenarios.campaign.single import single
from scenarios.key import content_hash, run_key
from scenarios.schema import Scenario
from server.errors import not_found
from server.paging import ListPage
from server.runs.changed import ChangedValue, changed_values
from server.runs.listing import Run, RunFilter
from server.runs.queue import Queue, Requested, check_length
from server.runs.worker import STEM, Keep
from server.settings import Settings
from server.store.models import RequestRow


def identify(scenario: Scenario, seeds: list[int]) -> tuple[dict[str, Any], str]:
    """Return the document of a run as it is kept, and its key."""
    document = json.loads(json.dumps(scenario.document, default=str))
    return document, run_key(content_hash(document), *seeds)


class Jobs(Requested[Run]):
    """The runs of the queue, and their files."""

    kind = "run"

    def __init__(self, queue: Queue, settings: Settings) -> None:
        super().__init__(queue, settings)
        self._changed: dict[str, list[ChangedValue]] = {}
        """The values that each run changes, which its id determines: computed when the run is listed first."""

    async def start(
        self, scenario: Scenario, seeds: list[int], label: str = "", *, everything: bool = False
    ) -> tuple[Run, bool]:
        """Queue a run, or return the same one if it exists; true when it is new. A name it is given is its name then.

        A run without the requested signals is computed once more, for its trace.

        Raises
        ------
        ApiError
            If too many wait, or the run is too long, or the same run is under way and keeps fewer signals.
        """
        self.check_enabled()
        await asyncio.to_thread(check_length, scenario, len(seeds), self._settings, "this run", "scenario")
        document, key = identify(scenario, seeds)
        return await self.enter(
            key=key,
            name=scenario.id,
            scenario_id=scenario.id,
            title=scenario.head.title,
            label=label,
            document=document,
            seeds=seeds,
            everything=everything,
            runs=len(seeds),
        )

    async def all(self, wanted: RunFilter, page: ListPage) -> list[Run]:
        """List the selected runs, newest first."""
        rows = await self._requests.all(self.kind, wanted, page)
        while new := {row.id: row.scenario_id for row in rows if row.id not in self._changed}:
            documents = await self._requests.documents([*new])
            found = await asyncio.to_thread(
                lambda: {one: changed_values(name, documents.get(one, {})) for one, name in new.items()}  # noqa: B023
            )
            self._changed |= found
        return [self.shown(row) for row in rows]

    async def remove(self, ids: Sequence[str] | None) -> int:
        """Remove some that have ended, all of them if none is named, with their files; results stay."""
        removed = await super().remove(ids)
        self._changed.clear()
        return removed

    async def campaign(self, row: RequestRow, on_progress: Callable[[int, int], None]) -> Campaign:
        """Return a run as a campaign; it is carried out on this machine."""
        folder = self._requests.folders[self.kind] / row.id
        await asyncio.to_thread(shutil.rmtree, folder, ignore_errors=True)
        with kept():
            one = await asyncio.to_thread(lambda: single(Scenario.load(row.document), row.seeds or []))
        return Campaign(
            one,
            self._queue.results,
            processes=self._queue.processes,
            trace=Keep(str(folder), self._settings.max_run_mb * 1_000_000, row.everything),
            on_progress=on_progress,
        )

    async def some(self, run_ids: list[str]) -> dict[str, Run]:
        """Return the known runs among some ids."""
        return {row.id: self.shown(row) for row in await self._requests.some(self.kind, run_ids)}

    async def traces(self, run_ids: list[str]) -> tuple[list[Run], list[Path]]:
        """Return runs, and the path of the trace of each; a run without a trace has no file there."""
        runs = [await self.get(run_id) for run_id in run_ids]
        return runs, [(self._requests.folders[self.kind] / run.id / STEM).with_suffix(".parquet") for run in runs]

    async def file(self, run_id: str, ending: str) -> tuple[Run, Path]:
        """Return a run that is done, and one of its files."""
        row = await self._requests.get(self.kind, run_id)
        run, path = self.shown(row), (self._requests.folders[self.kind] / row.id / STEM).with_suffix(ending)
        if run.state != "done" or not path.is_file():
            raise not_found(f"{ending[1:]} file of run", run_id, "a run has its files once it is done")
        return run, path

    async def scenario(self, run_id: str) -> Scenario:
        """Return the scenario of a run, with its first seed."""
        row = await self._requests.get(self.kind, run_id)
        document = row.document if not row.seeds else {**row.document, "seed": row.seeds[0]}
        with kept():
            return await asyncio.to_thread(Scenario.load, document)

    def shown(self, row: RequestRow) -> Run:
        """Return a run as the interface shows it, with its progress while it is under way."""
        run, campaign = Run.model_validate(row), self._queue.campaigns.get(row.id)
        if row.id not in self._changed:
            self._changed[row.id] = changed_values(row.scenario_id, row.document)
        run.changed = self._changed[row.id]
        return run if campaign is None else run.model_copy(update={"progress": campaign.progress})
