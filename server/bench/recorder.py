"""Records every signal of a live bench at full rate, in a thread of its own.

The engine hands over copies and continues; it never waits for the disk. If the disk cannot follow, or a limit is
reached, the recording ends there, whole and readable, and the event log says so. This thread also reads from the
history the ticks before the recording began.
"""

from __future__ import annotations

import math
import queue
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from server.store.recording import RecordingFile
from server.store.traces import table_of

QUEUE_BYTES = 64 << 20
"""Most bytes of rows on their way to the disk."""

BATCH_TICKS = 8192
FLUSH_S = 0.5
"""Rows wait at most this long to be written."""

STOPPED = "stopped"
COMPLETE = "it is as long as it was meant to be"
FULL = "it reached its size limit"
CLOSED = "the bench was closed"
WANTED = (STOPPED, COMPLETE, FULL, CLOSED)
"""Ends by a request or a setting; any other end is an alarm."""

Samples = NDArray[np.float32]


@dataclass(frozen=True)
class PastSpan:
    """A span of the history that the writer thread reads when its turn comes."""

    read: Callable[[int, int], Samples]
    first: int
    end: int


class Recorder:
    """One recording under way.

    Parameters
    ----------
    recording_id : str
        Its row and file.
    file : RecordingFile
        The file it is written to.
    schema : pa.Schema
        Columns of the file.
    dt_ms : float
        Device time of one tick.
    max_ticks : int
        Size limit.
    on_end : callable
        Called on the writer thread with the first tick, the ticks written and the reason.
    """

    def __init__(
        self,
        recording_id: str,
        file: RecordingFile,
        schema: Any,
        dt_ms: float,
        max_ticks: int,
        on_end: Callable[[int, int, str], None],
    ) -> None:
        self.id = recording_id
        self._file, self._schema, self._dt_ms = file, schema, dt_ms
        self._left, self._on_end = max_ticks, on_end
        self.taken = 0
        """Ticks taken so far."""
        self._full = FULL
        self._queue: queue.SimpleQueue[tuple[int, Samples] | PastSpan | str | None] = queue.SimpleQueue()
        self._bytes = 0
        self._lock = threading.Lock()
        self.reason = ""
        self._first: int | None = None
        self._end_tick: float = math.inf
        self._thread = threading.Thread(target=self._write, name=f"combbench-recorder-{recording_id[:8]}")
        self._thread.start()

    @property
    def has_begun(self) -> bool:
        """Whether it waits for nothing."""
        return self._end_tick < math.inf

    @property
    def total(self) -> int:
        """Ticks at which it ends by itself."""
        return self.taken + self._left

    @property
    def is_open(self) -> bool:
        """Whether it still takes rows."""
        return not self.reason

    def begin(self, past: PastSpan, ticks: int | None) -> None:
        """Take a span of the past; end the recording a number of ticks after it."""
        length = past.end - past.first
        if ticks is not None and length + ticks <= self._left:
            self._left, self._full = length + ticks, COMPLETE
        if length > self._left:
            past, length = PastSpan(past.read, past.end - self._left, past.end), self._left
        self._end_tick = past.end + self._left - length
        if length:
            self._queue.put(past)
            self._take(length)

    def append(self, first_tick: int, samples: Samples) -> None:
        """Take samples ``(n_signals, ticks)``; called on the engine thread."""
        if not self.is_open:
            return
        samples = samples[:, : self._left]
        with self._lock:
            self._bytes += samples.nbytes
            too_slow = self._bytes > QUEUE_BYTES
        if too_slow:
            self.stop("the disk could not keep up")
            return
        self._queue.put((first_tick, samples))
        self._take(samples.shape[1])

    def note(self, tick: int, line: str) -> None:
        """Take an event, as a line of JSON, unless the recording ends before its tick."""
        if self.is_open and tick < self._end_tick:
            self._queue.put(line)

    def stop(self, reason: str = STOPPED) -> None:
        """End the recording after the rows taken so far; returns at once."""
        if self.is_open:
            self.reason = reason
            self._queue.put(None)

    def join(self) -> None:
        """Wait until the file is whole."""
        self._thread.join()

    def _take(self, ticks: int) -> None:
        """Count ticks against the limit."""
        self.taken, self._left = self.taken + ticks, self._left - ticks
        if self._left <= 0:
            self.stop(self._full)

    def _write(self) -> None:
        """Write batches until the end or an error of the disk."""
        batch: list[Samples] = []
        first, held, due = 0, 0, time.monotonic() + FLUSH_S
        try:
            while True:
                try:
                    item = self._queue.get(timeout=FLUSH_S)
                except queue.Empty:
                    item = ""
                if isinstance(item, PastSpan):
                    self._write_past(item)
                elif isinstance(item, str):
                    if item:
                        self._file.note(item)
                elif item is not None and item[1].size:
                    first = first if batch else item[0]
                    batch.append(item[1])
                    held += item[1].shape[1]
                    with self._lock:
                        self._bytes -= item[1].nbytes
                if batch and (item is None or held >= BATCH_TICKS or time.monotonic() >= due):
                    self._put(first, np.hstack(batch))
                    batch, held, due = [], 0, time.monotonic() + FLUSH_S
                if item is None:
                    break
            self._end(self._file.finish())
        except OSError as error:
            self.reason = f"the disk failed: {error.strerror or error}"
            self._end(self._file.salvage())

    def _write_past(self, past: PastSpan) -> None:
        """Copy a span of the history; ticks overwritten meanwhile are missing at its old end."""
        for start in range(past.first, past.end, BATCH_TICKS):
            end = min(start + BATCH_TICKS, past.end)
            samples = past.read(start, end)
            if samples.shape[1]:
                self._put(end - samples.shape[1], samples)

    def _put(self, first: int, samples: Samples) -> None:
        self._first = first if self._first is None else self._first
        self._file.append(table_of(self._schema, first, self._dt_ms, samples))

    def _end(self, ticks: int) -> None:
        self._on_end(self._first or 0, ticks, self.reason)
