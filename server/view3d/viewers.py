"""The 3D scenes of all benches: each is built for its first viewer, and closed after its last one."""

from __future__ import annotations

import asyncio
import logging
import time
from pathlib import Path
from typing import Any, Protocol

from server.bench.bench import LiveBench
from server.view3d.gyroscope.parts import Parts
from server.view3d.gyroscope.pose import GyroscopeObserver
from server.view3d.layout import Layout
from server.view3d.pose import Observer, kept

log = logging.getLogger(__name__)

FRAME_S = 1.0 / 60.0


class Observing(Protocol):
    """Reads the moments of one bench."""

    def pose(self, looked: int | None = None) -> Any:
        """Return the pose of a past tick, if the history has it; else the present pose."""


class Scene(Protocol):
    """The picture of one bench; it shows the poses of its observer."""

    @property
    def path(self) -> Path:
        """The Unix socket of the scene, which only this user can open."""

    def show(self, pose: Any) -> None:
        """Move the parts."""

    def close(self) -> None:
        """Stop the server and disconnect its clients."""


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
    """The scene of one bench and the number of its viewers.

    A page that shows another moment gets a scene of its own from then on, so that other pages keep their moment.

    Parameters
    ----------
    session : LiveBench
        The bench.
    """

    def __init__(self, session: LiveBench) -> None:
        self._session = session
        self._watchers = 0
        self._scene: Scene | None = None
        self._ready = asyncio.Lock()
        self._task: asyncio.Task[None] | None = None
        self._own: dict[Looked, tuple[Scene, asyncio.Task[None]]] = {}

    @property
    def watchers(self) -> int:
        """Open 3D pages."""
        return self._watchers

    async def enter(self) -> Path:
        """Count a new viewer; return the socket of the scene."""
        self._watchers += 1
        try:
            async with self._ready:
                if self._scene is None:
                    self._scene = await asyncio.to_thread(build_scene, self._session)
                    self._task = asyncio.create_task(self._play(self._scene, None))
                return self._scene.path
        except BaseException:
            self._watchers -= 1
            raise

    async def leave(self) -> None:
        """Count a viewer that leaves; close the scene after the last one.

        A scene keeps a number for every message it has sent, and goes through all of them for each new viewer. A new
        scene keeps that short.
        """
        self._watchers -= 1
        async with self._ready:
            if self._watchers == 0:
                await self.close()

    async def own(self, looked: Looked) -> Path:
        """Build the scene of one page, as the shared one is now; return its socket."""
        scene = await asyncio.to_thread(build_scene, self._session)
        scene.show(observer_of(self._session).pose())
        self._own[looked] = scene, asyncio.create_task(self._play(scene, looked))
        return scene.path

    async def close_own(self, looked: Looked) -> None:
        """Close the scene of a page that leaves, if it has one."""
        if looked in self._own:
            scene, task = self._own.pop(looked)
            await _end(scene, task)

    async def close(self) -> None:
        """Stop moving and close the scenes."""
        for looked in list(self._own):
            await self.close_own(looked)
        task, scene, self._task, self._scene = self._task, self._scene, None, None
        if task is not None and scene is not None:
            await _end(scene, task)

    async def _play(self, scene: Scene, looked: Looked | None) -> None:
        """Show the bench 60 times a second: a page its moment, others now."""
        observer = observer_of(self._session)
        due, shown = time.monotonic(), None
        while True:
            try:
                at = kept(self._session.history, looked.tick) if looked is not None else None
                is_seen = looked is not None or self._watchers > len(self._own)
                if is_seen and (at is None or at != shown):  # a moment of the past stays as it is
                    scene.show(observer.pose(at))
                shown = at
            except Exception:
                log.exception("the 3D view of bench %s failed", self._session.id)
                return
            due = max(due + FRAME_S, time.monotonic())
            await asyncio.sleep(due - time.monotonic())


async def _end(scene: Scene, task: asyncio.Task[None]) -> None:
    """Stop moving a scene and close it."""
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
    await asyncio.to_thread(scene.close)


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


def build_scene(session: LiveBench) -> Scene:
    """Build the scene; viser is loaded here, so that nothing else waits for it."""
    from server.view3d.gyroscope.scene import GyroscopeScene
    from server.view3d.scene import ResonatorScene

    layout = layout_of(session)
    return ResonatorScene(layout) if isinstance(layout, Layout) else GyroscopeScene(layout)


def observer_of(session: LiveBench) -> Observing:
    """Return the observer of the poses that the scene of this bench shows."""
    layout = layout_of(session)
    return Observer(session, layout) if isinstance(layout, Layout) else GyroscopeObserver(session)


def layout_of(session: LiveBench) -> Layout | Parts:
    """Return where the parts are.

    A plant with axes is drawn as gyroscopes, any other as a resonator; a device without a drawing as the reference
    device.
    """
    axes = session.board.spec.axes
    return Parts(axes) if axes else Layout(session.board.spec.device.drawing)
