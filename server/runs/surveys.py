"""The results of campaigns as Parquet files in the data folder: written as results arrive, read in place."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from scenarios.campaign.parts import PART
from scenarios.campaign.survey import Survey
from server.runs.apart import FEW_RUNS, Apart, campaign, keep_up, report
from server.store.database import Database

log = logging.getLogger(__name__)

WAIT_S = 0.3
"""How long a reader waits for the newest results of a campaign under way."""
T = TypeVar("T")
Document = dict[str, Any]


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

    def follow(self, sweep_id: str, document: Document) -> Callable[[int, int], None]:
        """Return the callback of a campaign for each batch, in a thread of its own."""
        loop, written = asyncio.get_running_loop(), 0

        def progress(done: int, _total: int) -> None:
            nonlocal written
            if done - written >= PART:
                written = done
                loop.call_soon_threadsafe(self.write, sweep_id, document, done, True)

        return progress

    def write(self, sweep_id: str, document: Document, done: int, is_active: bool) -> None:
        """Have the files of a campaign brought up to date, without waiting for it."""
        self._start(sweep_id, document, done, is_active).add_done_callback(_tell)

    async def read(
        self, sweep_id: str, document: Document, done: int, is_active: bool, reader: Callable[[Survey], T]
    ) -> T:
        """Call a reader on the results so far.

        Parameters
        ----------
        done : int
            Runs that are done.
        is_active : bool
            Whether there may be more soon.
        """
        await self._ready(sweep_id, document, done, is_active)
        return await asyncio.to_thread(self._call, sweep_id, json.dumps(document, default=str), reader)

    async def report(self, sweep_id: str, document: Document, done: int, is_active: bool, name: str) -> str:
        """Return the report of a campaign; many curves take seconds."""
        await self._ready(sweep_id, document, done, is_active)
        return await self._apart.call(done, report, json.dumps(document, default=str), self.folder / sweep_id, name)

    def close(self) -> None:
        """End the active work; missing files are made at the next request."""
        self._apart.close()
        for task in self._under_way:
            task.cancel()

    def _call(self, sweep_id: str, text: str, reader: Callable[[Survey], T]) -> T:
        return reader(Survey(*campaign(text, self.folder / sweep_id)))

    def _start(self, sweep_id: str, document: Document, done: int, is_active: bool) -> asyncio.Task[None]:
        task = asyncio.create_task(self._bring_up(sweep_id, document, done, is_active))
        self._under_way.add(task)
        task.add_done_callback(self._under_way.discard)
        return task

    async def _ready(self, sweep_id: str, document: Document, done: int, is_active: bool) -> None:
        """Wait until the files are up to date; of a campaign under way that has some results, not for long."""
        task = self._start(sweep_id, document, done, is_active)
        if not (is_active and self._done.get(sweep_id, (0, 0))[0]):
            await task
            return
        task.add_done_callback(_tell)
        await asyncio.wait({task}, timeout=WAIT_S)

    async def _bring_up(self, sweep_id: str, document: Document, done: int, is_active: bool) -> None:
        """Write the results that the files lack; of a campaign that has ended, once."""
        known = self._done if is_active else self._ended
        text, folder = json.dumps(document, default=str), self.folder / sweep_id
        async with self._turn:
            _, parts = await asyncio.to_thread(campaign, text, folder)
            whole = await asyncio.to_thread(parts.whole)
            rows = await asyncio.to_thread(parts.rows)
            if whole < len(parts) and known.get(sweep_id) != (done, rows):
                # a user waits for the first results, and the process may have to be started
                begin = is_active and not rows
                size = 0 if begin else done - PART * whole
                options = {"to_end": not is_active, "begin": begin}
                await self._apart.call(size, keep_up, text, folder, self._database.url, **options)
                rows = await asyncio.to_thread(parts.rows)
                done = rows if begin else done
            known[sweep_id] = (done, rows)


def _tell(task: asyncio.Task[None]) -> None:
    """Log why files could not be written, where no request waits for them."""
    if not task.cancelled() and (error := task.exception()) is not None:
        log.error("files of a campaign could not be written", exc_info=error)
