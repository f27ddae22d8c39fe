"""The watchdog over the engine: it watches from a thread of its own and acts when the engine shows no activity.

It adds up silence: the time after a round was due in which the threads of the engine neither ran nor wanted to. A busy
machine delays the looks too, so a late look counts little, and a tenth of that while other threads of this process wait
for a processor. Long work, such as to compile a kernel, has a larger bound.
"""

from __future__ import annotations

import logging
import sys
import threading
import traceback
from collections.abc import Sequence
from typing import Protocol

from core.format import format_short
from server.bench.crew import Crew
from server.bench.engine import Engine, Workload
from server.bench.job import Job
from server.bench.pulse import Finger

log = logging.getLogger(__name__)

LOOK_S = 0.0125
MOST_S = 2 * LOOK_S
"""Most that a look counts, if it comes late."""
CROWDED = 0.1
"""Share that a look counts while other threads wait for a processor: one may hold the lock the engine waits for."""
SILENT_S = 0.1
"""Silence after which the engine hangs."""
GIVEN_UP_S = 5.0
"""Silence after which other threads take its place."""
LONG_S = 60.0
"""Work of one slice or job, without the waits for a processor, after which the engine hangs too."""


class Guarded(Protocol):
    """Takes care of the benches; called on the thread of the watchdog."""

    def hung(self, running: Sequence[Workload], held: Sequence[str], why: str) -> None:
        """Take benches to safe outputs that ran when the engine hung, in slices of the benches that are named."""

    def given_up(self, benches: Sequence[Workload]) -> None:
        """Let go of benches in whose slices the engine hangs for good."""


class Watchdog:
    """Looks at the engine again and again.

    Parameters
    ----------
    engine : Engine
        The engine.
    guarded : Guarded
        Takes care of the benches.
    finger : Finger, optional
        Feels the pulse of the threads of the engine.
    """

    def __init__(self, engine: Engine, guarded: Guarded, finger: Finger | None = None) -> None:
        self._engine, self._guarded, self._finger = engine, guarded, finger or Finger()
        self._looked = self._expected = engine.clock()
        self._blocked_s = self._worked_s = 0.0
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="combbench-watchdog", daemon=True)
        self.barks = False
        """Whether the engine hangs."""

    def start(self) -> None:
        """Look from now on."""
        self._thread.start()

    def stop(self) -> None:
        """Look no longer."""
        self._ended.set()
        self._thread.join(timeout=5.0)

    @property
    def is_alive(self) -> bool:
        """Whether it looks."""
        return self._thread.is_alive()

    def look(self) -> None:
        """Look once."""
        engine = self._engine
        now = engine.clock()
        passed, self._looked = now - self._looked, now
        if not engine.crew.main.is_alive():
            self._bark("the engine broke off")
            self._blocked_s += passed
            if not engine.crew.held or self._blocked_s >= GIVEN_UP_S:
                self._take_over()
            return
        expected = engine.expected
        if expected != self._expected or now <= expected:
            self._expected = expected
            self._calm()
            return
        pulse = self._finger.feel(engine.crew.threads, passed)
        counts = (CROWDED if pulse.is_crowded else 1.0) * min(passed, MOST_S)
        self._blocked_s = self._blocked_s + counts if pulse.is_blocked else 0.0
        self._worked_s += min(pulse.worked_s, MOST_S)
        if self._blocked_s >= SILENT_S or self._worked_s >= LONG_S:
            self._bark(f"the engine gave no sign for {format_short(now - expected, 's', 2)}")
        if self._blocked_s >= GIVEN_UP_S or self._worked_s >= 2 * LONG_S:
            self._take_over()

    def _run(self) -> None:
        while not self._ended.wait(LOOK_S):
            try:
                self.look()
            except Exception:
                log.exception("the watchdog could not look at the engine; it is tried again")

    def _calm(self) -> None:
        self._blocked_s = self._worked_s = 0.0
        if self.barks:
            self.barks = False
            log.warning("the engine turns again")

    def _bark(self, why: str) -> None:
        """Take running benches to safe outputs, once for each time that the engine hangs."""
        if self.barks:
            return
        self.barks = True
        running = self._engine.running
        if running:
            held = [thing.id for thing in self._engine.crew.held if not isinstance(thing, Job)]
            self._guarded.hung(running, held, why)
        log.error("%s; benches that ran: %d; where its threads are:\n%s", why, len(running), _stacks(self._engine.crew))

    def _take_over(self) -> None:
        """Let other threads turn the engine."""
        self._engine.take_over(self._guarded.given_up)
        self._looked = self._expected = self._engine.clock()
        self._blocked_s = self._worked_s = 0.0
        self.barks = False
        log.error("other threads turn the engine")


def _stacks(crew: Crew[Workload | Job]) -> str:
    """Return the stacks of the busy threads of the engine, for the log."""
    frames = sys._current_frames()
    busy = [one for one in crew.threads if one is crew.main or one.ident in crew.in_hand]
    found = [(one.name, frames[one.ident or 0]) for one in busy if one.ident in frames]
    return "\n".join(f"{name}:\n{''.join(traceback.format_stack(frame))}" for name, frame in found)
