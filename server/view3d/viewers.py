"""The 3D scenes of all benches: each is built for its first viewer, and closed after its last one."""

from __future__ import annotations

import asyncio
import logging
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.bench.bench import LiveBench
from server.view3d.device import DeviceModel
from server.view3d.gyroscope.gyroscope import GyroscopeModel
from server.view3d.resonator.resonator import ResonatorModel

if TYPE_CHECKING:
    from server.view3d.scene import Scene

log = logging.getLogger(__name__)

FRAME_S = 1.0 / 60.0


class Looked:
    """The tick that one page looks at; none for now."""

    def __init__(self) -> None:
        self.tick: int | None = None
        self.first = asyncio.Event()
        """Set once it has looked at any."""

    def look(self, tick: int | None) -> None:
        """Look at a tick, or at now."""
        self.tick = tick
        if tick is not None:
            self.first.set()


class Show:
    """The scenes of one bench and the number of its viewers.

    A page that shows another moment gets a scene of its own from then on, so that other pages keep their moment.

    Parameters
    ----------
    session : LiveBench
        The bench.
    """

    def __init__(self, session: LiveBench) -> None:
        self._session = session
        self.watchers = 0
        """Open 3D pages."""
        self._turn = asyncio.Lock()
        self._scenes: dict[Looked | None, tuple[Scene, asyncio.Task[None]]] = {}
        """The scenes of pages, and under ``None`` the scene of all other pages."""

    async def enter(self) -> Path:
        """Count a new viewer; return the socket of the scene."""
        self.watchers += 1
        try:
            async with self._turn:
                return self._scenes[None][0].path if None in self._scenes else await self.open(None)
        except BaseException:
            self.watchers -= 1
            raise

    async def leave(self, looked: Looked) -> None:
        """Count a viewer that leaves, and close its scene; close the shared scene after the last viewer.

        A scene keeps a number for every message it has sent, and goes through all of them for each new viewer. A new
        scene keeps that short.
        """
        await self._close(looked)
        self.watchers -= 1
        async with self._turn:
            if self.watchers == 0:
                await self.close()

    async def open(self, looked: Looked | None) -> Path:
        """Build the shared scene, or the scene of one page, as the bench is now; return its socket."""
        device, scene = await asyncio.to_thread(build_scene, self._session)
        scene.show(device.pose())
        self._scenes[looked] = scene, asyncio.create_task(self._play(device, scene, looked))
        return scene.path

    async def close(self) -> None:
        """Stop moving and close the scenes."""
        for looked in list(self._scenes):
            await self._close(looked)

    async def _close(self, looked: Looked | None) -> None:
        """Stop moving a scene and close it, if there is one."""
        if looked in self._scenes:
            scene, task = self._scenes.pop(looked)
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)
            await asyncio.to_thread(scene.close)

    async def _play(self, device: DeviceModel[Any], scene: Scene, looked: Looked | None) -> None:
        """Show the bench 60 times a second: a page its moment, others now."""
        due, shown = time.monotonic(), None
        while True:
            try:
                at = device.kept(looked.tick) if looked is not None else None
                is_seen = looked is not None or self.watchers >= len(self._scenes)  # not each page has its own
                if is_seen and (at is None or at != shown):  # a moment of the past stays as it is
                    scene.show(device.pose(at))
                shown = at
            except Exception:
                log.exception("the 3D view of bench %s failed", self._session.id)
                return
            due = max(due + FRAME_S, time.monotonic())
            await asyncio.sleep(due - time.monotonic())


class Viewers:
    """One show per bench."""

    def __init__(self) -> None:
        self._shows: dict[str, Show] = {}

    def show_of(self, session: LiveBench) -> Show:
        """Return the show of a bench; made on the first visit."""
        if session.id not in self._shows:
            self._shows[session.id] = Show(session)
        return self._shows[session.id]

    def watchers(self, bench_id: str) -> int:
        """Count the pages that watch the scene of a bench."""
        return self._shows[bench_id].watchers if bench_id in self._shows else 0

    async def drop(self, bench_id: str) -> None:
        """Close the show of a bench that is gone."""
        show = self._shows.pop(bench_id, None)
        if show is not None:
            await show.close()

    async def close(self) -> None:
        """Close every show."""
        for bench_id in list(self._shows):
            await self.drop(bench_id)


def build_scene(session: LiveBench) -> tuple[DeviceModel[Any], Scene]:
    """Build the scene of a bench; viser is loaded here, so that nothing else waits for it."""
    from server.view3d.scene import Scene

    device = device_of(session)
    return device, Scene(device)


def device_of(session: LiveBench) -> DeviceModel[Any]:
    """Return the device of a bench as it is drawn: gyroscopes if its plant has axes, otherwise a resonator."""
    return GyroscopeModel(session) if session.board.spec.axes else ResonatorModel(session)
