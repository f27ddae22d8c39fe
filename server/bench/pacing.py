"""The pace of a bench: integer sample targets on an absolute clock; lost time is counted and shown."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING

from server.bench.commands import DEFAULT_SCALE, MAX_SCALE

if TYPE_CHECKING:
    from server.bench.replay import TickSource

AXES_SCALE = 0.1
"""Device seconds per wall second of a plant with axes."""

CATCH_UP_S = 0.05
"""Wall time a bench may be behind. More lag is dropped, counted and shown."""

WINDOW_S = 1.0
"""Wall time over which the achieved rate is measured."""

CAPPED_BELOW = 0.8
"""Share of its rate below which a bench lags."""

CAPPED_AFTER_S = 3.0
"""Wall time for which it lags before it is called capped: a shorter stall is no news."""


class Pacer:
    """Turns wall time into a tick to reach.

    The target is the integer part of ``(now - anchor) * rate`` and never a sum of steps, so it does not drift. Time
    more than `CATCH_UP_S` behind is dropped: the anchor moves and the loss is counted.

    Parameters
    ----------
    dt_s : float
        Device time of one tick.
    scale : float or None
        Device seconds per wall second; none runs as fast as possible.
    """

    def __init__(self, dt_s: float, scale: float | None) -> None:
        self.dt_s = dt_s
        self.scale = scale
        """Device seconds per wall second; none is as fast as possible. `rescale` changes it."""
        self._wall = 0.0
        self._tick = 0
        self._due = 0
        self._seen: deque[tuple[float, int, int]] = deque()
        self._lags_since: float | None = None
        self.fast_to: int | None = None
        """The tick up to which it runs as fast as possible, whatever its time scale; none: at its time scale."""
        self.given_up_s = 0.0
        self.overruns = 0

    def hurry(self, fast_to: int | None, tick: int, now: float) -> None:
        """Run as fast as possible to a tick, or no longer; from there on the time scale counts."""
        self.fast_to = fast_to if fast_to is not None and fast_to > tick else None
        self.anchor(tick, now)

    def anchor(self, tick: int, now: float) -> None:
        """Start counting here: after a start, a pause, a step, a restore."""
        self._wall, self._tick, self._due = now, tick, 0
        self._lags_since = None
        self._seen.clear()
        self._seen.append((now, tick, tick))

    def rescale(self, scale: float | None, tick: int, now: float, is_running: bool) -> None:
        """Change the time scale from now on; ticks due at the old one stay due."""
        if self.fast_to is not None:
            self.hurry(None, tick, now)
        if scale == self.scale:
            return
        due = self.target(tick, now) if is_running else None
        self.scale = scale
        self.anchor(tick if due is None else max(due, tick), now)

    def target(self, tick: int, now: float) -> int | None:
        """Return the tick to reach by now, or none when there is no limit.

        Parameters
        ----------
        tick : int
            Where the bench is.
        now : float
            Wall clock in seconds.
        """
        if self.fast_to is not None:
            if tick < self.fast_to:
                return self.fast_to
            self.hurry(None, tick, now)
        if self.scale is None:
            return None
        rate = self.scale / self.dt_s
        target = self._tick + int((now - self._wall) * rate)
        excess = target - tick - max(1, int(CATCH_UP_S * rate))
        if excess > 0:
            self._wall += excess / rate
            self._due += excess
            self.given_up_s += excess / rate
            target -= excess
        return target

    def due(self, tick: int) -> float:
        """Return the time at which a tick becomes the target, s; infinite where time sets no target."""
        if self.scale is None or self.fast_to is not None:
            return math.inf
        return self._wall + (tick - self._tick + 1e-3) * self.dt_s / self.scale

    def record(self, tick: int, target: int | None, now: float) -> None:
        """Note the tick that a round of work reached."""
        if self.fast_to is not None:
            target = None
        if target is not None and tick < target:
            self.overruns += 1
        due = self._due + (target if target is not None else tick)
        self._seen.append((now, tick, due))
        while len(self._seen) > 2 and now - self._seen[1][0] >= WINDOW_S:
            self._seen.popleft()
        if self.scale is None or self.fast_to is not None or self.achieved >= CAPPED_BELOW * self.scale:
            self._lags_since = None
        elif self._lags_since is None:
            self._lags_since = now

    @property
    def achieved(self) -> float:
        """Device seconds per wall second over the last second."""
        if len(self._seen) < 2:
            return self.scale or 0.0
        (wall_0, tick_0, due_0), (wall_1, tick_1, due_1) = self._seen[0], self._seen[-1]
        if self.scale is None or self.fast_to is not None:
            elapsed = wall_1 - wall_0
            return (tick_1 - tick_0) * self.dt_s / elapsed if elapsed > 0 else 0.0
        # The ticks due are the measure, not the clock: at 1 us/s a second holds less than one tick.
        return self.scale * (tick_1 - tick_0) / (due_1 - due_0) if due_1 > due_0 else self.scale

    @property
    def capped(self) -> bool:
        """Whether the machine has not kept up for some time."""
        return self._lags_since is not None and self._seen[-1][0] - self._lags_since >= CAPPED_AFTER_S


def usual_scale(board: TickSource) -> float:
    """Return the time scale that suits a device.

    The scale of a resonator; near real time for a plant in seconds; between them for a plant with axes, whose amplitude
    and rate take some hundred periods to settle.
    """
    if board.spec.axes:
        return AXES_SCALE
    return min(MAX_SCALE, DEFAULT_SCALE * max(1.0, board.spec.device.oscillator().time_unit_ms))
