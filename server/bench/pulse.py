"""The pulse of threads: whether they work, or wait for something that may never come.

Linux reports for each thread its running time and whether it sleeps. A thread that waits for a processor or for a disk
is at work, however long that takes, and so is a thread that waits for the interpreter's lock, because it requests the
lock again and again. It may also wait for a lock of another thread that waits for a processor: while threads of this
process do that, they are crowded. Other systems report nothing, and every thread that has not ended is at work there.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

SLEEPS, WANTS_PROCESSOR, WAITS_FOR_DISK = "S", "R", "D"
CROWDED_ABOVE = 0.1
"""Time that all threads of the process together waited for a processor, over the time that has passed."""
OTHERS_WORK = ("llvmlite", "importlib", "_frozen_importlib", "_frozen_importlib_external", "pyarrow")
"""Packages in which a thread sleeps while another works for it: it compiles, imports or reads a file."""


@dataclass(frozen=True)
class Pulse:
    """The work of threads since the last look."""

    is_blocked: bool
    """No thread has run, and none waits for a processor or for a thread that works."""
    worked_s: float
    """Processor time of all of them, or the whole time if one of them slept in between."""
    is_crowded: bool = False
    """They are blocked, but other threads wait for a processor or a disk, and may hold their locks."""


class Finger:
    """Feels the pulse of threads again and again."""

    def __init__(self) -> None:
        self._ran: dict[int, str] = {}
        self._waited_ns: dict[str, int] = {}

    def feel(self, threads: Sequence[threading.Thread], passed_s: float) -> Pulse:
        """Return the activity of threads in the time since the last call."""
        before, states = self._ran, {}
        self._ran = {}
        for thread in threads:
            folder = Path(f"/proc/self/task/{thread.native_id}")
            try:
                self._ran[thread.ident or 0] = (folder / "schedstat").read_text()
                states[thread.ident or 0] = _state(folder)
            except OSError:  # another system, or it has just ended
                return Pulse(is_blocked=False, worked_s=passed_s)
        if all(state == SLEEPS for state in states.values()):
            is_crowded = self._is_crowded(passed_s)  # now and at the next look, which compares
            if before == self._ran and not _others_work(list(states)):
                return Pulse(is_blocked=True, worked_s=0.0, is_crowded=is_crowded)
        if WANTS_PROCESSOR not in states.values():
            return Pulse(is_blocked=False, worked_s=passed_s)
        ran_ns = sum(int(text.split()[0]) - int(before.get(key, text).split()[0]) for key, text in self._ran.items())
        return Pulse(is_blocked=False, worked_s=min(passed_s, 1e-9 * ran_ns))

    def _is_crowded(self, passed_s: float) -> bool:
        """Whether threads of this process wait for a processor or a disk; so they do as long as nothing is known."""
        before, self._waited_ns = self._waited_ns, {}
        has_disk_wait = False
        for folder in Path("/proc/self/task").iterdir():
            with suppress(OSError):  # it has just ended
                self._waited_ns[folder.name] = int((folder / "schedstat").read_text().split()[1])
                has_disk_wait |= _state(folder) == WAITS_FOR_DISK
        waited_ns = sum(now - before.get(name, now) for name, now in self._waited_ns.items())
        return not before or has_disk_wait or 1e-9 * waited_ns > CROWDED_ABOVE * passed_s


def _state(folder: Path) -> str:
    """Return the letter of the system for the state of a thread."""
    return (folder / "stat").read_text().rpartition(") ")[2][:1]


def _others_work(numbers: Sequence[int]) -> bool:
    """Whether one of these threads is inside a package that releases the interpreter's lock."""
    frames = sys._current_frames()
    for number in numbers:
        frame = frames.get(number)
        while frame is not None:
            if str(frame.f_globals.get("__name__", "")).partition(".")[0] in OTHERS_WORK:
                return True
            frame = frame.f_back
    return False
