"""Watches a bench for a step of a sheet: conditions that hold for a time of the device.

The bench is looked at where a window ends, at ticks that are whole multiples of it, and runs no further at a time than
to the next of these. So the result depends on ticks alone, never on the pace of the bench or on requests. Its state is
its own: it is kept with the checkpoints of the bench, and continues with them after a crash.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray
from core.board.history import History
from core.board.rows import Rows
from scenarios.sheets.look import Finding, look, signals_of
from scenarios.sheets.sheet import Hold
from server.bench.bench import LiveBench
from server.bench.replay import TickSource
from server.bench.view import KeptWatch

COLUMNS = 160
"""Columns of a small trace, each with minimum and maximum."""
MOST_TICKS = 20_000
"""Most ticks of a small trace, the last ones of a long step: the server has them for each student, on disk too."""


@dataclass(frozen=True)
class Held:
    """How far a step has come; replaced whole, so that the event loop may read it."""

    findings: list[Finding]
    held_ms: float


@dataclass(frozen=True)
class Done:
    """The values of a step when it was done."""

    values: list[float | str | None]
    trace: dict[str, Any]
    tick: int


class Seen:
    """Some signals of a bench, up to the tick to which they were taken.

    Parameters
    ----------
    names : list of str
        The signals.
    window : int
        Ticks that are looked at together.
    ticks : int
        Ticks that are kept at least.
    dt_ms : float
        Device time of one tick.
    """

    board: TickSource

    def __init__(self, names: list[str], window: int, ticks: int, dt_ms: float) -> None:
        self.column_of = {name: position for position, name in enumerate(names)}
        self.history, self._window, self.dt_ms = History(len(names), 0, ticks), window, dt_ms

    def take(self, bench: LiveBench, since: int) -> None:
        """Take the new rows of the bench since the last time, and not before a tick."""
        self.board, source = bench.board, bench.history
        first = max(since, self.history.end_tick, source.first_tick)
        if first < self.board.tick:
            columns = [bench.column_of[name] for name in self.column_of]
            self.append(first, source.read(columns, first, self.board.tick).T)

    def append(self, first: int, samples: NDArray[Any]) -> None:
        """Add ticks, ticks by signals."""
        self.history.append(Rows.of(first, samples, len(self.column_of)))

    def last(self, ticks: int) -> NDArray[np.float32]:
        """Return the last ticks, ticks by signals."""
        end = self.history.end_tick
        return self.history.read(list(self.column_of.values()), end - ticks, end).T

    def samples(self, signal: str) -> FloatArray:
        """Return a signal over the last window."""
        end = self.history.end_tick
        found: FloatArray = self.history.read([self.column_of[signal]], end - self._window, end)[0].astype(np.float64)
        return found


class SheetWatch:
    """Looks at a bench for one step; on the engine's thread.

    Parameters
    ----------
    step : Hold
        The step.
    limits : list
        The ends of its conditions, by the facts of the student.
    since_tick : int
        Tick at which the step was opened: earlier ticks do not count.
    dt_ms : float
        Device time of one tick.
    done : callable
        Called once, when the conditions have held for as long as they are to.
    """

    def __init__(
        self,
        step: Hold,
        limits: list[tuple[float, float] | None],
        since_tick: int,
        dt_ms: float,
        done: Callable[[Done], None],
    ) -> None:
        self.step, self._limits, self._since, self._done = step, limits, since_tick, done
        self.window = max(1, round(step.window_ms / dt_ms))
        self._needed = max(1, round(step.for_ms / dt_ms / self.window))
        self._dt_ms, self._found = dt_ms, cast(Done | None, None)
        self.jumped(since_tick)

    def room(self, tick: int, ticks: int) -> int:
        """Return how far a bench may run at a time."""
        return min(ticks, self.window - tick % self.window)

    def jumped(self, tick: int) -> None:
        """Count anew from this tick: the bench was reset, or went back to a moment."""
        self._since, self._last, self._windows = tick, tick, 0
        ticks = max(2 * self.window, min((self._needed + 1) * self.window, MOST_TICKS))
        self._seen = Seen(signals_of(self.step), self.window, ticks, self._dt_ms)
        self.now = Held([], 0.0)

    def look(self, bench: LiveBench) -> None:
        """Look at the bench if a window ends at its tick."""
        tick = bench.board.tick
        if tick % self.window or tick == self._last or self._found is not None:
            return
        self._seen.take(bench, self._since)
        first = tick - self.window
        if first < self._since or self._seen.history.first_tick > first:
            return
        if first != self._last:
            self._windows = 0
        self._last = tick
        findings = look(self.step, self._limits, self._seen)
        self._windows = self._windows + 1 if all(found.holds for found in findings) else 0
        self.now = Held(findings, min(self._windows, self._needed) * self.window * bench.dt_ms)
        if self._windows >= self._needed:
            self._found = Done([found.value for found in findings], self._trace(bench), tick)
            self._done(self._found)

    def kept(self, bench: LiveBench) -> KeptWatch:
        """Return how far it is, at the tick of the bench."""
        self._seen.take(bench, self._since)
        document = {
            "step": self.step.id,
            "since": self._since,
            "last": self._last,
            "windows": self._windows,
            "now": asdict(self.now),
            "found": asdict(self._found) if self._found is not None else None,
            "end": self._seen.history.end_tick,
        }
        return KeptWatch(document, self._seen.last((self._windows + 1) * self.window))

    def go_on(self, kept: KeptWatch) -> None:
        """Continue from a checkpoint; the watch of another step leaves nothing."""
        document = kept.document
        if document["step"] != self.step.id:
            return
        self._since, self._last, self._windows = (document[name] for name in ("since", "last", "windows"))
        self._seen.append(document["end"] - len(kept.samples), kept.samples)
        self.now = Held([Finding(*found) for found in document["now"]["findings"]], document["now"]["held_ms"])
        if document["found"] is not None:  # the crash came before it was written
            self._found = Done(**document["found"])
            self._done(self._found)

    def _trace(self, bench: LiveBench) -> dict[str, Any]:
        """Return a small trace of the time in which the conditions held."""
        history, end = self._seen.history, bench.board.tick
        start = max(end - self._needed * self.window, history.first_tick)
        if not self.step.trace or end - start < 2:
            return {}
        columns = min(COLUMNS, end - start)
        names = {signal.name: signal for signal in bench.signals}
        cut = history.columns([self._seen.column_of[name] for name in self.step.trace], start, end, columns)
        lines = {
            name: {
                "unit": names[name].unit,
                "low": [round(float(value), 6) for value in low],
                "high": [round(float(value), 6) for value in high],
            }
            for name, (low, high) in zip(self.step.trace, cut, strict=True)
        }
        return {"start_ms": start * bench.dt_ms, "end_ms": end * bench.dt_ms, "signals": lines}
