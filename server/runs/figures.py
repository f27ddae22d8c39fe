"""Figures of the gallery: one for each scenario and version of the code.

Figures built into an image or a wheel are in `BUILT`. The others are made when the gallery is first opened, the cards
in sight first, by the worker processes of headless runs at their low priority, one after the other: a run that a person
starts waits for one figure at most. Results in the table of runs are not computed again, and new ones are added to it.
A scenario that fails, or a full disk, gives one line in the log and stops nothing.

``python -m server.runs.figures`` makes the figures of the whole library, for an image or a wheel.
"""

from __future__ import annotations

import asyncio
import json
import logging
import multiprocessing
from collections.abc import Awaitable, Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from scenarios.campaign.campaign import Campaign
from scenarios.campaign.single import compared, single
from scenarios.library import get, ids, is_demo, library
from scenarios.report.traces import write_json
from scenarios.run import DEFAULT_SAMPLES
from scenarios.schema import Scenario
from server.runs.jobs import identify
from server.runs.queue import Queue
from server.runs.worker import draw
from server.settings import Settings

log = logging.getLogger(__name__)

BUILT = Path(__file__).resolve().parent / "built_figures"
"""Figures made when an image or a wheel was built; a checkout has none."""


@dataclass(frozen=True)
class ScenarioFigure:
    """The result of one scenario: its summary, and its picture as SVG."""

    key: str
    summary: dict[str, Any]
    svg: str


class ScenarioFigures:
    """Makes the figures of the library that are not there yet, and keeps all of them at hand.

    Parameters
    ----------
    queue : Queue
        Whose worker processes make them.
    settings : Settings
        Data folder, and whether they are made.
    """

    def __init__(self, queue: Queue, settings: Settings) -> None:
        self._queue, self._settings = queue, settings
        self._folder = settings.data / "figures"
        self._task: asyncio.Task[None] | None = None
        self._missing: dict[str, Scenario] | None = None
        self._first: list[str] = []
        self._reading = asyncio.Lock()
        self._ready: Callable[[], Awaitable[None]] | None = None
        self.made: dict[str, ScenarioFigure] = {}
        self.failed: dict[str, str] = {}
        self.problem = ""

    @property
    def total(self) -> int:
        """How many there will be."""
        return len(library())

    @cached_property
    def keys(self) -> dict[str, str]:
        """The id of the run of each library scenario with its own seed; its figure is known by the same."""
        return {scenario.id: key_of(scenario) for scenario in library()}

    @property
    def is_making(self) -> bool:
        """Whether some are still being made."""
        return self._task is not None and not self._task.done()

    def start(self, ready: Callable[[], Awaitable[None]]) -> None:
        """Allow figures to be made, once the server is ready for the work."""
        self._ready = ready

    async def ask(self, first: list[str]) -> None:
        """Read the existing figures, then make the others, these scenarios first."""
        self._first = first
        async with self._reading:
            if self._missing is None:
                found = await asyncio.to_thread(self._read)
                self._missing = found if self._settings.figures and self._settings.run_workers else {}
        if self._missing and not self.is_making and self._ready is not None:
            self._task = asyncio.create_task(self._make_all(self._missing, self._ready))

    async def stop(self) -> None:
        """Stop making figures; finished figures stay."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    async def _make_all(self, missing: dict[str, Scenario], ready: Callable[[], Awaitable[None]]) -> None:
        await ready()
        while missing:
            name = next((name for name in self._first if name in missing), next(iter(missing)))
            scenario = missing.pop(name)
            try:
                figure = ScenarioFigure(self.keys[name], **await self._draw(scenario))
                self.made[scenario.id] = figure
                await asyncio.to_thread(keep, self._folder, figure)
            except OSError as error:
                self._tell(f"the figure of {scenario.id} could not be kept: {error.strerror or error}")
            except Exception as error:
                self.failed[scenario.id] = str(error) or type(error).__name__
                self._tell(f"the figure of {scenario.id} could not be made: {self.failed[scenario.id]}")
        log.info("figures of the gallery: %d of %d exist", len(self.made), self.total)

    async def _draw(self, scenario: Scenario) -> dict[str, Any]:
        campaign = Campaign(
            single(scenario, [scenario.spec.seed]), self._queue.results, processes=self._queue.processes, trace=draw
        )
        await self._queue.run(campaign)
        return dict(campaign.kept)

    def _tell(self, text: str) -> None:
        self.problem = " ".join(text.split())
        log.warning("%s", self.problem)

    def _read(self) -> dict[str, Scenario]:
        """Read the kept figures, delete the figures of other versions, and return the missing ones by cost."""
        for path in self._folder.glob("*.json"):
            if path.stem not in self.keys.values():
                path.unlink(missing_ok=True)
        for name, key in self.keys.items():
            for folder in (self._folder, BUILT):
                try:
                    kept = json.loads((folder / f"{key}.json").read_text("utf-8"))
                    self.made[name] = ScenarioFigure(key, kept["summary"], kept["svg"])
                    break
                except (OSError, ValueError, KeyError, TypeError):  # missing, or not whole: it is made again
                    continue
        missing = [scenario for scenario in library() if scenario.id not in self.made]
        missing.sort(key=lambda scenario: (not is_demo(scenario.id), cost(scenario)))
        return {scenario.id: scenario for scenario in missing}


def key_of(scenario: Scenario) -> str:
    """Return the key of a figure: the id of the run with the scenario's own seed."""
    return identify(scenario, [scenario.spec.seed])[1][:32]


def keep(folder: Path, figure: ScenarioFigure) -> None:
    """Write a figure into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    write_json(folder / f"{figure.key}.json", {"summary": figure.summary, "svg": figure.svg})


def cost(scenario: Scenario) -> int:
    """Return about how long a scenario takes: its ticks. Most studies take a moment."""
    return 0 if scenario.study is not None else scenario.samples or DEFAULT_SAMPLES


def build(name: str, folder: Path = BUILT) -> None:
    """Make the figure of one scenario, unless the folder has it."""
    scenario = get(name)
    seed = scenario.spec.seed
    key = key_of(scenario)
    if (folder / f"{key}.json").exists():
        return
    others = [[outcome.model_dump_json() for outcome in outcomes] for outcomes in compared(scenario, [seed]).values()]
    document, _ = identify(scenario, [seed])
    keep(folder, ScenarioFigure(key, **draw(document, seed, [[], *others])[1]))


def main() -> None:
    """Make all figures on all processors, and delete the figures of other versions."""
    keys = {f"{key_of(scenario)}.json" for scenario in library()}
    for path in BUILT.glob("*.json"):
        if path.name not in keys:
            path.unlink()
    ordered = sorted(ids(), key=lambda name: -cost(get(name)))
    with ProcessPoolExecutor(mp_context=multiprocessing.get_context("forkserver")) as pool:
        print(f"figures made: {len(list(pool.map(build, ordered)))}")


if __name__ == "__main__":
    main()
