"""A record from a file: its columns, in the units of the bench, at regular samples."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from core.errors import InputError, one_line, short, unknown
from core.measured_record import UNLABELLED, MeasuredRecord
from scenarios.records import live
from scenarios.records.binary_table import mat_columns, npz_columns, parquet_columns
from scenarios.records.clock import Grid, displacements_at, grid, rows_at, said_lost
from scenarios.records.columns import Columns, Numbers, assigned, factor
from scenarios.records.hdf5_table import hdf5_columns, netcdf_columns
from scenarios.records.text_table import mistake, text_columns

READERS: Mapping[str, Callable[[bytes], Columns]] = {
    ".csv": text_columns,
    ".txt": text_columns,
    ".tsv": text_columns,
    ".dat": text_columns,
    ".parquet": parquet_columns,
    ".mat": mat_columns,
    ".npz": npz_columns,
    ".nc": netcdf_columns,
    ".h5": hdf5_columns,
    ".hdf5": hdf5_columns,
}
MOST_BYTES = 1 << 30
MOST_LABELS = 100
LONGEST_LABEL = 64
Pairing = Literal["next", "last"]


@dataclass(frozen=True)
class ReadRecord:
    """A record, the columns it was read from, and sentences about it."""

    record: MeasuredRecord
    columns: dict[str, str]
    notes: list[str]


def read_record(
    content: bytes,
    name: str,
    *,
    named: Mapping[str, str] | None = None,
    rate_khz: float | None = None,
    pairing: Pairing = "next",
) -> ReadRecord:
    r"""Return the record in a file.

    Parameters
    ----------
    content, name
        The bytes of the file, and its name, whose ending says the format.
    named : mapping, optional
        The column of ``time``, ``drive``, ``displacement`` or ``label``, where it has no usual name.
    rate_khz : float, optional
        Samples for each ms of a file without times.
    pairing : {'next', 'last'}
        ``next``: the voltage of a row acts from this sample on. ``last``: it acted until this sample.

    Raises
    ------
    InputError
        Naming row, column and reason.
    """
    ending = Path(name).suffix.lower()
    if ending not in (*READERS, live.ENDING):
        raise unknown("kind of file", ending or name, (*READERS, live.ENDING), "record")
    if len(content) > MOST_BYTES:
        raise InputError(f"has {len(content)} bytes; at most {MOST_BYTES}", "record")
    if ending == live.ENDING:
        return _of_instrument(content)
    columns = READERS[ending](content)
    place = assigned(columns, named or {})
    _refuse_uneven(columns, place)
    drive, displacement = (_in_units(columns, part, place[part]) for part in ("drive", "displacement"))
    _refuse_lost(columns, place["drive"], drive)
    _refuse_endless(columns, place["displacement"], displacement)
    notes, where, rows = list[str](), None, np.arange(len(drive))
    if "time" in place:
        time_ms = _in_units(columns, "time", place["time"])
        where = grid(columns, place["time"], time_ms)
        rows = rows_at(where, time_ms)
        drive, displacement = drive[rows], displacements_at(where, time_ms, displacement)
        notes += [where.note] if where.note else []
    rate = _rate(where, rate_khz)
    label, names = _labels(columns, place.get("label"), rows)
    if pairing == "last":
        drive, displacement = drive[1:], displacement[:-1]
        label = None if label is None else label[:-1]
    lost = int(np.isnan(displacement).sum())
    if lost and not notes:
        notes.append(said_lost(lost))
    return ReadRecord(MeasuredRecord(rate, drive.copy(), displacement.copy(), label, names), place, notes)


def _of_instrument(content: bytes) -> ReadRecord:
    """Return the record that an instrument sent: in the units of the bench, at regular samples."""
    about, pairs = live.content_of(content)
    record = MeasuredRecord(float(about["rate_khz"]), pairs[:, 0].copy(), pairs[:, 1].copy())
    lost = int(np.isnan(record.displacement).sum())
    notes = [said_lost(lost)] if lost else []
    return ReadRecord(record, dict(zip(("drive", "displacement"), about["names"], strict=True)), notes)


def _in_units(columns: Columns, part: str, name: str) -> Numbers:
    """Return a column in the unit of the bench."""
    if name not in columns.numbers:
        raise mistake(columns, name)
    scale = factor(columns, part, name)
    numbers = columns.numbers[name]
    return numbers if scale == 1.0 else numbers * scale


def _refuse_lost(columns: Columns, name: str, drive: Numbers) -> None:
    """Refuse a voltage that is not known: a bench cannot tell a lost voltage from a voltage of 0."""
    wrong = np.flatnonzero(~np.isfinite(drive))
    if len(wrong):
        row = columns.row(int(wrong[0]))
        raise InputError(f"row {row}, column {one_line(short(name))}: a voltage must be a finite number", "record")


def _refuse_uneven(columns: Columns, place: Mapping[str, str]) -> None:
    """Refuse vectors of different lengths."""
    lengths = {name: len(columns.numbers.get(name, columns.words.get(name, ()))) for name in place.values()}
    (first, usual), *others = lengths.items()
    for name, length in others:
        if length != usual:
            texts = (
                f"column {one_line(short(one))} has {count} rows" for one, count in ((first, usual), (name, length))
            )
            raise InputError(", ".join(texts), "record")


def _refuse_endless(columns: Columns, name: str, displacement: Numbers) -> None:
    """Refuse a displacement without end, which is no lost sample."""
    wrong = np.flatnonzero(np.isinf(displacement))
    if len(wrong):
        row = columns.row(int(wrong[0]))
        raise InputError(f"row {row}, column {one_line(short(name))}: a displacement must be finite", "record")


def _rate(where: Grid | None, rate_khz: float | None) -> float:
    if where is None:
        if rate_khz is None:
            raise InputError("has no column of times", "record", "give its rate: rate_khz, samples for each ms")
        return float(rate_khz)
    if rate_khz is not None and abs(rate_khz / where.rate_khz - 1.0) > 1e-3:
        text = f"is {rate_khz:g}, but the times of the file say {where.rate_khz:g}"
        raise InputError(text, "rate_khz", "leave it out")
    return where.rate_khz


def _labels(
    columns: Columns, name: str | None, rows: NDArray[np.int64]
) -> tuple[NDArray[np.int64] | None, tuple[str, ...]]:
    """Return the label of each sample as an index, and the names."""
    if name is None:
        return None, ()
    if name in columns.words:
        words = [word.strip() for word in columns.words[name]]
    else:
        words = ["" if np.isnan(number) else f"{number:g}" for number in columns.numbers[name].tolist()]
    names = tuple(dict.fromkeys(word for word in words if word))
    if len(names) > MOST_LABELS:
        raise InputError(f"column {one_line(short(name))} has {len(names)} labels; at most {MOST_LABELS}", "record")
    if any(len(word) > LONGEST_LABEL for word in names):
        raise InputError(f"column {one_line(short(name))} has a label of over {LONGEST_LABEL} characters", "record")
    index = {word: i for i, word in enumerate(names)} | {"": UNLABELLED}
    return np.array([index[word] for word in words], dtype=np.int64)[rows], names
