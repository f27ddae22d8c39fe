"""Records every signal of a live bench at full rate, in a thread of its own.

The engine hands over copies and goes on; it never waits for the disk. If the disk cannot follow, or the size
limit is reached, the recording ends there, whole and readable, and the event log says so.
"""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from server.store.recording import RecordingFile
from server.store.traces import table_of

QUEUE_BYTES = 64 << 20
"""Rows on their way to the disk, at most."""

BATCH_TICKS = 8192
FLUSH_S = 0.5
"""What is not written yet is never older than this."""

NOTHING = (0, np.empty((0, 0), np.float32))


class Recorder:
    """One recording under way.

    Parameters
    ----------
    recording_id : str
        Its row and file.
    file : RecordingFile
        Where it goes.
    schema : pa.Schema
        Columns of the file.
    dt_ms : float
        Device time of one tick.
    max_ticks : int
        Size limit.
    on_end : callable
        Called on the writer thread with the ticks written and the reason.
    """

    def __init__(
        self,
        recording_id: str,
        file: RecordingFile,
        schema: Any,
        dt_ms: float,
        max_ticks: int,
        on_end: Callable[[int, str], None],
    ) -> None:
        self.id = recording_id
        self._file, self._schema, self._dt_ms = file, schema, dt_ms
        self._left, self._on_end = max_ticks, on_end
        self._queue: queue.SimpleQueue[tuple[int, NDArray[np.float32]] | None] = queue.SimpleQueue()
        self._bytes = 0
        self._lock = threading.Lock()
        self.reason = ""
        self._thread = threading.Thread(target=self._write, name=f"combbench-recorder-{recording_id[:8]}")
        self._thread.start()

    @property
    def is_open(self) -> bool:
        """Whether it still takes rows."""
        return not self.reason

    def append(self, first_tick: int, samples: NDArray[np.float32]) -> None:
        """Take samples ``(n_signals, ticks)``; called on the engine thread."""
        if not self.is_open:
            return
        with self._lock:
            self._bytes += samples.nbytes
            too_slow = self._bytes > QUEUE_BYTES
        self._left -= samples.shape[1]
        if too_slow:
            self.stop("the disk could not keep up")
        elif self._left < 0:
            self.stop("it reached its size limit")
        else:
            self._queue.put((first_tick, samples))

    def stop(self, reason: str = "stopped") -> None:
        """End the recording behind what has been taken; returns at once."""
        if self.is_open:
            self.reason = reason
            self._queue.put(None)

    def join(self) -> None:
        """Wait until the file is whole."""
        self._thread.join()

    def _write(self) -> None:
        """Write batches until the end or an error of the disk."""
        batch: list[NDArray[np.float32]] = []
        first, held, due = 0, 0, time.monotonic() + FLUSH_S
        try:
            while True:
                try:
                    item = self._queue.get(timeout=FLUSH_S)
                except queue.Empty:
                    item = NOTHING
                if item is not None and item[1].size:
                    first = first if batch else item[0]
                    batch.append(item[1])
                    held += item[1].shape[1]
                    with self._lock:
                        self._bytes -= item[1].nbytes
                if batch and (item is None or held >= BATCH_TICKS or time.monotonic() >= due):
                    self._file.append(table_of(self._schema, first, self._dt_ms, np.hstack(batch)))
                    batch, held, due = [], 0, time.monotonic() + FLUSH_S
                if item is None:
                    break
            self._on_end(self._file.finish(), self.reason)
        except OSError as error:
            self.reason = f"the disk failed: {error.strerror or error}"
            self._on_end(self._file.salvage(), self.reason)
