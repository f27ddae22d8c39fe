"""The shelf of records: a folder with a file for each, under its key."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from core.errors import InputError
from core.measured_record import MeasuredRecord, PlayedRecord, find_on
from scenarios.kernel_cache import user_cache
from scenarios.record_folders import FOLDER, folders
from scenarios.records import live

KEY = "0123456789abcdef"


class RecordFolder:
    """Records in a folder, which is made when the first is kept.

    Without a path it is the first of `folders`, and the records in the others are found too.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._path = path

    @property
    def path(self) -> Path:
        """The folder: the given one, the one of the environment, or one in the user's cache."""
        return self._sought[0]

    @property
    def _sought(self) -> list[Path]:
        if self._path is not None:
            return [self._path]
        return [*map(Path, folders())] or [user_cache() / "records"]

    def get(self, key: str) -> PlayedRecord | None:
        """Return a record, also a record of an instrument; nothing when its file is absent or damaged."""
        if len(key) != 64 or set(key) - set(KEY):
            return None
        if record := live.growing(key):
            return record
        for folder in self._sought:
            for read, ending in ((_loaded, ".npz"), (live.opened, live.ENDING)):
                with suppress(OSError, ValueError, KeyError, TypeError, BadZipFile):  # absent, or damaged
                    return read(folder / f"{key}{ending}")
        return None

    def whole(self, key: str) -> MeasuredRecord | None:
        """Return a record that has ended, with all its samples at once; nothing when its file is absent or damaged."""
        found = self.get(key)
        return found if isinstance(found, MeasuredRecord) else None

    def keep(self, record: MeasuredRecord) -> str:
        """Keep a record, and return its key; a record that is here already is not written again.

        Raises
        ------
        InputError
            When the folder cannot be written.
        """
        key, columns = record.key, dict[str, Any](drive=record.drive, displacement=record.displacement)
        if record.label is not None:
            columns["label"] = record.label
        about = json.dumps({"rate_khz": record.rate_khz, "hypotheses": list(record.hypotheses)})
        try:
            self.path.mkdir(parents=True, exist_ok=True, mode=0o700)
            if not (self.path / f"{key}.npz").exists():
                with tempfile.NamedTemporaryFile(dir=self.path, delete=False) as file:
                    np.savez(file, about=np.array(about), **columns)
                os.replace(file.name, self.path / f"{key}.npz")
        except OSError as error:
            raise InputError(f"cannot write to {self.path}: {error.strerror}", FOLDER) from None
        return key

    @contextmanager
    def keeping(self, record: MeasuredRecord) -> Iterator[None]:
        """Keep a record for good, unless the input is refused within."""
        is_new = self.get(record.key) is None
        key = self.keep(record)
        try:
            yield
        except InputError:
            if is_new:
                self.remove(key)
            raise

    def remove(self, key: str) -> None:
        """Remove a record."""
        (self.path / f"{key}.npz").unlink(missing_ok=True)
        _loaded.cache_clear()

    def keys(self) -> Iterator[str]:
        """Return the keys of all records, in order."""
        return iter(sorted(file.stem for file in self.path.glob("*.npz")))


@lru_cache(maxsize=4)
def _loaded(file: Path) -> MeasuredRecord:
    """Return the record in a file; an error is not kept, because the file may come later."""
    with file.open("rb") as content, np.load(content, allow_pickle=False) as kept:
        about = json.loads(str(kept["about"]))
        label = kept["label"] if "label" in kept else None
        columns = kept["drive"], kept["displacement"]
    record = MeasuredRecord(about["rate_khz"], *columns, label, tuple(about["hypotheses"]))
    if record.key != file.stem:
        raise ValueError(f"{file} is damaged")
    return record


def prepare() -> RecordFolder:
    """Let the benches of this process find the records of the folder."""
    folder = RecordFolder()
    find_on(folder)
    return folder
