"""The results of campaigns as Parquet files in the data folder: written as results arrive, read in place."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

from scenarios.campaign.parquet import PART
from scenarios.campaign.survey import Survey
from server.runs.apart import FEW_RUNS, Apart, campaign, keep_up, report
from server.store.database import Database
from server.store.models import RequestRow

log = logging.getLogger(__name__)

WAIT_S = 0.3
"""How long a reader waits for the newest results of a campaign under way."""
T = TypeVar("T")


@dataclass(frozen=True)
class CampaignStanding:
    """How far a campaign is.

    Parameters
    ----------
    id : str
        Its id, and the name of its folder.
    text : str
        Its document, as JSON.
    done : int
        Runs that are done.
    is_active : bool
        Whether there may be more soon.
    """

    id: str
    text: str
    done: int
    is_active: bool

    @classmethod
    def of(cls, row: RequestRow, done: int, is_active: bool) -> CampaignStanding:
        """Return how far the campaign of a request is."""
        return cls(row.id, json.dumps(row.document, default=str), done, is_active)


class Surveys:
    """Keeps the files of campaigns up to date, and reads them.

    Outcomes become rows in a process apart, unless they are few. Files are read in a thread: that holds the
    interpreter's lock for moments only.

    Parameters
    ----------
    database : Database
        Where the results are.
    folder : Path
        Where each campaign has a folder of files.
    """

    def __init__(self, database: Database, folder: Path) -> None:
        self.folder = folder
        self._database = database
        self._apart = Apart(FEW_RUNS)
        self._turn = asyncio.Lock()
        self._done: dict[str, tuple[int, int]] = {}  # runs that were done, and rows that the files had
        self._ended: dict[str, tuple[int, int]] = {}
        self._under_way: set[asyncio.Task[None]] = set()

    def follow(self, at: CampaignStanding) -> Callable[[int, int], None]:
        """Return the callback of a campaign for each batch, in a thread of its own."""
        loop, written = asyncio.get_running_loop(), 0

        def progress(done: int, _total: int) -> None:
            nonlocal written
            if done - written >= PART:
                written = done
                loop.call_soon_threadsafe(self.write, replace(at, done=done))

        return progress

    def write(self, at: CampaignStanding) -> None:
        """Have the files of a campaign brought up to date, without waiting for it."""
        self._start(at).add_done_callback(_tell)

    async def read(self, at: CampaignStanding, reader: Callable[[Survey], T]) -> T:
        """Call a reader on the results so far."""
        await self._ready(at)
        return await asyncio.to_thread(lambda: reader(Survey(*campaign(at.text, self.folder / at.id))))

    async def report(self, at: CampaignStanding, name: str) -> str:
        """Return the report of a campaign; many curves take seconds."""
        await self._ready(at)
        return await self._apart.call(at.done, report, at.text, self.folder / at.id, name)

    def close(self) -> None:
        """End the active work; missing files are made at the next request."""
        self._apart.close()
        for task in self._under_way:
            task.cancel()

    def _start(self, at: CampaignStanding) -> asyncio.Task[None]:
        task = asyncio.create_task(self._bring_up(at))
        self._under_way.add(task)
        task.add_done_callback(self._under_way.discard)
        return task

    async def _ready(self, at: CampaignStanding) -> None:
        """Wait until the files are up to date; of a campaign under way that has some results, not for long."""
        task = self._start(at)
        if not (at.is_active and self._done.get(at.id, (0, 0))[0]):
            await task
            return
        task.add_done_callback(_tell)
        await asyncio.wait({task}, timeout=WAIT_S)

    async def _bring_up(self, at: CampaignStanding) -> None:
        """Write the results that the files lack; of a campaign that has ended, once."""
        known, done = self._done if at.is_active else self._ended, at.done
        folder = self.folder / at.id
        async with self._turn:
            _, parts = await asyncio.to_thread(campaign, at.text, folder)
            whole = await asyncio.to_thread(parts.whole)
            rows = await asyncio.to_thread(parts.rows)
            if whole < len(parts) and known.get(at.id) != (done, rows):
                # a user waits for the first results, and the process may have to be started
                begin = at.is_active and not rows
                size = 0 if begin else done - PART * whole
                options = {"to_end": not at.is_active, "begin": begin}
                await self._apart.call(size, keep_up, at.text, folder, self._database.url, **options)
                rows = await asyncio.to_thread(parts.rows)
                done = rows if begin else done
            known[at.id] = (done, rows)


def _tell(task: asyncio.Task[None]) -> None:
    """Log why files could not be written, where no request waits for them."""
    if not task.cancelled() and (error := task.exception()) is not None:
        log.error("files of a campaign could not be written", exc_info=error)
