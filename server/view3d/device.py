"""The device of a bench as it is drawn: its parts, its poses, and how a pose moves and marks the parts."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from core.board.commands import Inject
from core.board.instances import faults_of
from core.format import format_in
from server.bench.bench import LiveBench
from server.view3d.marks import Marks
from server.view3d.part import ScenePart, ScenePicture
from server.view3d.pose import Active, Pose
from server.view3d.solids import FloatArray, View

P = TypeVar("P", bound=Pose)


class DeviceModel(ABC, Generic[P]):
    """The device of one bench.

    Parameters
    ----------
    session : LiveBench
        The bench.
    signals : sequence of str
        The signals that its poses are read from; a record of a device has fewer.
    """

    blank: P
    """The pose of a bench that has no tick yet."""
    origin_um = 0.0
    """Place along x of the part that faults act on."""

    def __init__(self, session: LiveBench, signals: Sequence[str]) -> None:
        spec = session.board.spec
        known = {signal.name for signal in session.signals}
        self._session, self._signals = session, [name for name in signals if name in known]
        self._indices = session.indices(self._signals)
        self._faults: dict[str, type[Any]] = {
            name: params for name, params in faults_of(spec.axes, spec.library).items() if f"faults.{name}" in known
        }
        self._severities = session.indices([f"faults.{name}" for name in self._faults])
        self._known: dict[str, Any] = {}
        self._marked: Any = None
        self._marks: Marks
        self._added: dict[str, ScenePart] = {}

    @abstractmethod
    def views(self) -> dict[str, View]:
        """Return the presets of the camera by their names on the page."""

    @abstractmethod
    def parts(self) -> dict[str, ScenePart]:
        """Return the parts that are always there, by their names in the scene."""

    @abstractmethod
    def read(self, head: int, rate_ticks_s: float, looked: int | None) -> tuple[P, int]:
        """Return the motion of the device, and the tick that is shown.

        Parameters
        ----------
        head : int
            The tick after the last one.
        rate_ticks_s : float
            Ticks per wall second; 0 for a bench that is paused, and for a past tick.
        looked : int or None
            The past tick.
        """

    @abstractmethod
    def mark(self, pose: P) -> Marks:
        """Return the marks of a pose."""

    @abstractmethod
    def move(self, picture: ScenePicture, pose: P) -> None:
        """Place the parts as in a pose."""

    def kept(self, looked: int | None) -> int | None:
        """Return a tick that is looked at if the history has it."""
        history = self._session.history
        return looked if looked is not None and history.first_tick <= looked < history.end_tick else None

    def pose(self, looked: int | None = None) -> P:
        """Return the pose of a tick of the history; else the present pose, or the pose of the strobe."""
        session, history = self._session, self._session.history
        looked = self.kept(looked)
        head = history.end_tick if looked is None else looked + 1
        if head <= history.first_tick:
            return self.blank
        # A bench that runs as fast as possible is strobed like a bench in real time.
        scale = session.status.achieved_scale if looked is None and session.is_running else 0.0
        pose, tick = self.read(head, scale / (session.dt_ms * 1e-3), looked)
        when = f"at {format_in(looked * session.dt_ms, 'ms', 3)}" if looked is not None else ""
        return replace(pose, faults=self._acting(tick, looked), when=when)

    def picture(self, pose: P) -> ScenePicture:
        """Return the picture of a pose."""
        # A ramp moves in steps of two figures, not at every frame.
        marked = [(fault.block, fault.params, f"{fault.severity:.2g}") for fault in pose.faults], pose.contact
        if marked != self._marked:
            self._marked, self._marks = marked, self.mark(pose)
            self._added = self._marks.parts(self.origin_um)
        picture = ScenePicture(self._added)
        self._marks.colour(picture)
        self.move(picture, pose)
        picture.set("/caption", text=pose.caption)
        picture.set("/when", text=pose.when)
        return picture

    def _acting(self, tick: int, looked: int | None) -> tuple[Active, ...]:
        """Return the faults that act; one healed a moment ago is still known by its last parameters."""
        severities = finite(self._session.history.read(self._severities, tick, tick + 1))[:, 0]
        self._known |= dict(self._session.board.faults)
        known = self._known
        if looked is not None and severities.any():
            known = known | self._injected(looked)
        return tuple(
            Active(block, known[name], severity)
            for (name, block), severity in zip(self._faults.items(), severities.tolist(), strict=True)
            if severity != 0.0 and name in known
        )

    def _injected(self, tick: int) -> dict[str, Any]:
        """Return the parameters that each fault was last given by a tick, as the log has them."""
        found: dict[str, Any] = {}
        for event in self._session.events.after(0)[1]:
            name = event.command.get("fault") if event.command is not None else None
            if event.tick <= tick and event.kind == Inject.kind and name in self._faults:
                found[name] = self._faults[name].Params.model_validate(event.new)
        return found


def finite(values: ArrayLike) -> FloatArray:
    """Return values with 0 where there is none."""
    found: FloatArray = np.nan_to_num(np.asarray(values, dtype=float), nan=0.0, posinf=0.0, neginf=0.0)
    return found
