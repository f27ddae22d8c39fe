"""A record that is being measured: a file that grows by the blocks of an instrument, and that a board plays meanwhile.

Its samples never change, so a run of it up to a sample gives the same bits at any time.
"""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import weakref
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from core.errors import InputError
from core.measured_record import Stretch
from scenarios.records.arrivals import Arrivals
from scenarios.records.line import PAIR, BlockHead, LineHeader
from scenarios.records.order import BlockOrder

ENDING = ".live"
ABOUT_BYTES = 4096
"""Beginning of the file: facts about the record as JSON, filled up with spaces."""
CUT_OFF = "its server ended meanwhile"
"""Why a record has ended whose file does not say why."""
_growing: weakref.WeakValueDictionary[str, LiveRecord] = weakref.WeakValueDictionary()
"""The records that grow in this process, by their keys."""


class LiveRecord:
    """A record in a file of pairs of drive and displacement; it has no labels.

    Parameters
    ----------
    path : Path
        The file, whose name is the key.
    descriptor : int
        The open file.
    about : dict
        Rate, name of the source, names of the columns, pairing.
    is_growing : bool
        Whether blocks still come.

    Attributes
    ----------
    ended : str
        Why it has ended; empty while it grows. The file says it too, unless a crash came first.
    """

    has_labels = False

    def __init__(self, path: Path, descriptor: int, about: dict[str, Any], *, is_growing: bool) -> None:
        self.path, self.key, self.is_growing = path, path.stem, is_growing
        self.rate_khz, self.source, self.hypotheses = float(about["rate_khz"]), str(about["source"]), ()
        self.names: list[str] = about["names"]
        self.ended = "" if is_growing else str(about.get("ended", CUT_OFF))
        self.samples = max(0, (os.fstat(descriptor).st_size - ABOUT_BYTES) // PAIR)
        self.is_connected = is_growing
        self.order = BlockOrder(self.rate_khz, bool(about["shots"]), **about.get("counts", {}))
        self.arrivals = Arrivals()
        self._is_paired_last = about["pairing"] == "last"
        self._descriptor, self._about = descriptor, about
        self._held = 0.0
        self._carried = np.empty((0, 2))
        weakref.finalize(self, os.close, descriptor)

    @classmethod
    def begin(cls, folder: Path, header: LineHeader) -> LiveRecord:
        """Begin a record without samples.

        Raises
        ------
        InputError
            When the folder cannot be written.
        """
        path = folder / f"{secrets.token_hex(32)}{ENDING}"
        about = header.model_dump(include={"rate_khz", "source", "names", "pairing", "shots"})
        try:
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600)
            os.pwrite(descriptor, _beginning(about), 0)
        except OSError as error:
            raise InputError(f"cannot write to {folder}: {error.strerror}", "records") from None
        record = cls(path, descriptor, about, is_growing=True)
        record.order.begin(header.session)
        _growing[record.key] = record
        return record

    def take(self, head: BlockHead, pairs: NDArray[np.float64], most: int) -> None:
        """Add a block: missing samples are lost and the voltage is held; a late or doubled block is left out.

        Raises
        ------
        InputError
            When the record would be too long, or the disk is full; nothing of the block is in the record then.
        """
        lost = self.order.place(head)
        if lost is None:
            return
        rows = np.concatenate((np.tile((self._held, np.nan), (lost, 1)), pairs)) if lost else pairs
        self._held = float(pairs[-1, 0])
        if self._is_paired_last:
            every = np.concatenate((self._carried, rows))
            self._carried = every[-1:]
            rows = np.column_stack((every[1:, 0], every[:-1, 1]))
        if self.samples + len(rows) > most:
            raise InputError(f"would have {self.samples + len(rows)} samples; at most {most}", "record")
        self._write(rows.astype("<f8").tobytes())
        self.samples += len(rows)

    def _write(self, content: bytes) -> None:
        begin = at = ABOUT_BYTES + PAIR * self.samples
        try:
            while content:
                written = os.pwrite(self._descriptor, content, at)
                content, at = content[written:], at + written
        except OSError as error:
            with contextlib.suppress(OSError):
                os.ftruncate(self._descriptor, begin)
            raise InputError(f"cannot be written: {error.strerror}", "record") from None

    def stretch(self, first: int, end: int) -> Stretch:
        """Return some samples."""
        content = os.pread(self._descriptor, PAIR * (end - first), ABOUT_BYTES + PAIR * first)
        pairs = np.frombuffer(content, "<f8").reshape(-1, 2)
        return pairs[:, 0], pairs[:, 1], None

    def end(self, why: str) -> None:
        """End for a reason: no more blocks come."""
        self.ended, self.is_growing, self.is_connected = why, False, False
        _growing.pop(self.key, None)
        with contextlib.suppress(OSError):
            about = {**self._about, "ended": why[:200], "counts": self.order.counts()}
            os.pwrite(self._descriptor, _beginning(about), 0)

    @property
    def last_line(self) -> str:
        """The end of the record in a sentence, with the name of its file."""
        kept = f"it is kept as {self.key[:12]}….live" if self.samples else "it has no sample"
        return f"the record of instrument {self.source} ends at sample {self.samples}: {self.ended}; {kept}"

    def remove(self) -> None:
        """End, and remove the file."""
        self.end("it is removed")
        self.path.unlink(missing_ok=True)


def _beginning(about: dict[str, Any]) -> bytes:
    return json.dumps(about).encode().ljust(ABOUT_BYTES)


def growing(key: str) -> LiveRecord | None:
    """Return the record with this key if it grows in this process."""
    return _growing.get(key)


def content_of(content: bytes) -> tuple[dict[str, Any], NDArray[np.float64]]:
    """Return the facts and the samples in the bytes of such a file.

    Raises
    ------
    InputError
        When it is another file.
    """
    try:
        about = dict(json.loads(content[:ABOUT_BYTES]))
        count = (len(content) - ABOUT_BYTES) // PAIR
        return about, np.frombuffer(content, "<f8", 2 * count, ABOUT_BYTES).reshape(count, 2)
    except (ValueError, TypeError):
        raise InputError("is no record of an instrument", "record") from None


def opened(path: Path) -> LiveRecord:
    """Return the record in a file, with the samples that it has now.

    Raises
    ------
    OSError, ValueError, KeyError, TypeError
        When the file is absent or damaged.
    """
    descriptor = os.open(path, os.O_RDONLY)
    try:
        about = json.loads(os.pread(descriptor, ABOUT_BYTES, 0))
        return LiveRecord(path, descriptor, about, is_growing=False)
    except BaseException:
        with contextlib.suppress(OSError):
            os.close(descriptor)
        raise
