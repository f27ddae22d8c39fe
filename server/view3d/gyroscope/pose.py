"""The pose of gyroscopes: one moment of a bench whose plant has axes, read from its history."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from core.board.instances import faults_of
from core.board.spec import Spec
from core.control.sense_axis_sync import SenseAxisSync
from core.format import format_short
from server.bench.bench import LiveBench
from server.bench.description import period_of
from server.view3d.gyroscope.orbit import caption, full_scale, magnified, met
from server.view3d.layout import FloatArray
from server.view3d.motion import SEEN_HZ, STROBE_HZ
from server.view3d.pose import Active, acting, kept, when

PERIODS, LONG = 3.2, 400.0
"""Drive periods looked at: for the strobe and the orbit, and for the largest values."""
ORBIT_PERIODS, ORBIT_POINTS = 2.0, 96
RING_STEPS = 180
"""Number of lengths of the arc that shows a rate; it is small, so that noise seldom moves it."""


@dataclass(frozen=True)
class GyroscopePose:
    """One moment.

    Parameters
    ----------
    places : tuple of tuple of float
        x and y of each mass, exaggerated, um.
    orbits : tuple of ndarray, shape (points, 2)
        The same over the last periods; they change only with the places.
    turn : float
        The rate as a share of the rate of half the ring, signed.
    rate : str
        The rate in words.
    force : float or None
        The force with which the first follows its partner, as a share of its largest; none where it does not follow.
    largest_force : str
        That largest force in words.
    faults : tuple of Active
        The faults that act.
    caption : str
        The differences from the true motion, in words.
    when : str
        The moment in words, if it is not the present.
    """

    places: tuple[tuple[float, float], ...] = ()
    orbits: tuple[FloatArray, ...] = field(default=(), compare=False)
    turn: float = 0.0
    rate: str = ""
    force: float | None = None
    largest_force: str = ""
    faults: tuple[Active, ...] = ()
    caption: str = ""
    when: str = ""


class GyroscopeObserver:
    """Reads the moments of one bench.

    Parameters
    ----------
    session : LiveBench
        The bench.
    """

    def __init__(self, session: LiveBench) -> None:
        self._session = session
        axes = session.board.spec.axes
        self._faults: dict[str, type[Any]] = faults_of(axes, session.board.spec.library)
        moved = [f"plant.{axis}" for axis in axes]
        self._indices = session.indices([*moved, "rate.rate", f"drive.{axes[1]}.force"])
        self._severities = session.indices([f"faults.{name}" for name in self._faults])
        self._known: dict[str, Any] = {}
        self._factors = (1.0, 1.0)
        self._half_ring = 100.0

    def pose(self, looked: int | None = None) -> GyroscopePose:
        """Return the pose of a tick of the history; else the present pose, or the pose of the strobe."""
        session, history = self._session, self._session.history
        looked = kept(history, looked)
        head = history.end_tick if looked is None else looked + 1
        period = period_of(session) or 1.0
        first = max(head - math.ceil(PERIODS * period), history.first_tick)
        if head <= history.first_tick:
            return GyroscopePose()
        recent = _finite(history.read(self._indices, first, head))
        largest = np.abs(_finite(history.columns(self._indices, head - round(LONG * period), head, 1))).max(axis=(1, 2))
        self._magnify(largest)
        ticks_s = (session.status.achieved_scale if session.is_running else 0.0) / (session.dt_ms * 1e-3)
        is_strobed = looked is None and ticks_s > SEEN_HZ * period
        at = None
        if is_strobed:
            at = met(recent[0 if largest[0] >= largest[1] else 1], (time.monotonic() * STROBE_HZ) % 1.0)
        at = len(recent[0]) - 1 if at is None else at
        scaled = recent[:-2].reshape(-1, 2, recent.shape[1]) * np.array(self._factors)[:, None]
        start = max(0, recent.shape[1] - round(ORBIT_PERIODS * period))
        step = max(1, (recent.shape[1] - start) // ORBIT_POINTS)
        rate, force = recent[-2:, at].tolist()
        severities = _finite(history.read(self._severities, first + at, first + at + 1))[:, 0]
        follows = _follows(session.board.spec)
        return GyroscopePose(
            places=tuple((x, y) for x, y in scaled[:, :, at].tolist()),
            orbits=tuple(orbit[:, start::step].T for orbit in scaled),
            turn=round(rate / self._half_ring * RING_STEPS) / RING_STEPS,
            rate=_signed(rate, self._half_ring),
            force=force / float(largest[-1]) if follows and largest[-1] > 0.0 else None,
            largest_force=format_short(float(largest[-1]), "uN", 2) if follows else "",
            faults=acting(session, self._faults, self._known, severities, looked),
            caption=caption(self._factors, self._half_ring, is_strobed),
            when=when(session, looked),
        )

    def _magnify(self, largest: FloatArray) -> None:
        """Choose the exaggerations from the largest recent values, one pair of factors for all masses."""
        x, y = largest[:-2].reshape(-1, 2).max(axis=0).tolist()
        self._factors = magnified((x, y), self._factors)
        self._half_ring = full_scale(float(largest[-2]), self._half_ring)


def _follows(spec: Spec) -> bool:
    """Return whether a driving controller makes a device follow its partner."""
    driving = (spec.controllers[name].params for name in spec.driving.values())
    return any(isinstance(params, SenseAxisSync.Params) and params.follow == "partner" for params in driving)


def _signed(rate: float, half_ring: float) -> str:
    """Write a rate with its sign, as fine as the ring shows it."""
    shown = round(rate / half_ring, 2) * half_ring
    return ("+" if shown > 0.0 else "") + format_short(shown, "deg/s", 3)


def _finite(values: Any) -> FloatArray:
    """Return values with 0 where there is none."""
    finite: FloatArray = np.nan_to_num(np.asarray(values, dtype=float), nan=0.0, posinf=0.0, neginf=0.0)
    return finite
