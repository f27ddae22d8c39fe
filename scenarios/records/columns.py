"""The columns of a file: their names, units and numbers, and the place of each row in the file."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from core.errors import InputError, one_line, short, unknown
from core.measured_record import MOST_SAMPLES

Numbers = NDArray[np.float64]

MOST_COLUMNS = 1000
MOST_NUMBERS = 4 * MOST_SAMPLES
"""Numbers of all columns together, 640 MB."""

VOLTS = {"v": 1.0, "mv": 1e-3, "kv": 1e3}
MICROMETRES = {"m": 1e6, "mm": 1e3, "um": 1.0, "nm": 1e-3, "pm": 1e-6}
MILLISECONDS = {"s": 1e3, "ms": 1.0, "us": 1e-3, "ns": 1e-6}
UNITS: Mapping[str, Mapping[str, float]] = {"drive": VOLTS, "displacement": MICROMETRES, "time": MILLISECONDS}
"""Factors to the units of the bench: V, um, ms."""
USUAL = {"drive": "V", "displacement": "um", "time": "s"}
"""The unit of a column that names none."""
NAMES: Mapping[str, Sequence[str]] = {
    "time": ("time", "t", "timestamp"),
    "drive": ("drive", "drive.voltage", "drive_voltage", "voltage", "u", "vd", "vin", "input", "excitation"),
    "displacement": (
        "displacement",
        "sensor.displacement",
        "sensor_displacement",
        "y",
        "x",
        "position",
        "output",
        "response",
    ),
    "label": ("label", "truth", "fault", "state"),
}
"""The names by which columns are found without a map."""
NEEDED = ("drive", "displacement")
_IN_BRACKETS = re.compile(r"^(.*?)\s*[(\[]\s*([^)\]]*?)\s*[)\]]$")
_BEHIND = re.compile(r"^(.+)_([A-Za-zµμ]{1,2})$")


@dataclass
class Columns:
    """Columns of a file as they are.

    Parameters
    ----------
    names : list of str
        All of them.
    numbers, words : dict
        The columns of numbers, and the columns that are words.
    units : dict
        The units that the file names beside the columns.
    first_row : int
        The line of the first sample, for refusals.
    rows : array of int, optional
        The line of each sample, where they do not follow each other.
    decimal : str
        The decimal sign of words.
    """

    names: list[str]
    numbers: dict[str, Numbers] = field(repr=False)
    words: dict[str, list[str]] = field(default_factory=dict, repr=False)
    units: dict[str, str] = field(default_factory=dict)
    first_row: int = 1
    rows: NDArray[np.int64] | None = field(default=None, repr=False)
    decimal: str = "."

    def __post_init__(self) -> None:
        """Refuse two columns of one name."""
        refuse_large(len(self.names), 0)
        twice = [name for i, name in enumerate(self.names) if name in self.names[:i]]
        if twice:
            raise InputError(f"has two columns {one_line(short(twice[0]))}", "record")

    def row(self, i: int) -> int:
        """Return the row of a sample, as an editor counts them."""
        return self.first_row + i if self.rows is None else int(self.rows[i])


def refuse_large(columns: int, samples: int) -> None:
    """Refuse a table by the size that its file announces, before any of it is read.

    Raises
    ------
    InputError
        For too many columns, rows, or numbers.
    """
    if columns > MOST_COLUMNS:
        raise InputError(f"has {columns} columns; at most {MOST_COLUMNS}", "record")
    if samples > MOST_SAMPLES:
        raise InputError(f"has {samples} rows; at most {MOST_SAMPLES}", "record")
    if columns * samples > MOST_NUMBERS:
        raise InputError(f"has {columns} columns of {samples} rows; at most {MOST_NUMBERS} numbers", "record")


def split_unit(name: str) -> tuple[str, str]:
    """Return the name of a column without its unit, and the unit: of ``drive (mV)``, ``y [um]`` or ``time_ms``."""
    if found := _IN_BRACKETS.match(name):
        return found[1], plain_unit(found[2])
    if (found := _BEHIND.match(name)) and any(plain_unit(found[2]) in units for units in UNITS.values()):
        return found[1], plain_unit(found[2])
    return name, ""


def plain_unit(unit: str) -> str:
    """Return a unit in ASCII and small letters."""
    return unit.replace("µ", "u").replace("μ", "u").strip().lower()


def assigned(columns: Columns, given: Mapping[str, str]) -> dict[str, str]:
    """Return which column is time, drive, displacement and label; a map comes before the usual names.

    Raises
    ------
    InputError
        For a map that names no part or no column, or a column that is needed and not found.
    """
    for part, name in given.items():
        if part not in NAMES:
            raise unknown("part", part, NAMES, "map")
        if name not in columns.names:
            raise unknown("column", name, columns.names, f"map.{part}")
    found = by_usual_names(columns, given)
    for part in NEEDED:
        if part not in found:
            there = ", ".join(one_line(short(name)) for name in columns.names[:20])
            text = f"has no column for the {part}; its columns are {there}"
            raise InputError(text, "record", f"name it: map {part}=COLUMN")
    return found


def by_usual_names(columns: Columns, given: Mapping[str, str]) -> dict[str, str]:
    """Return the given columns, and for each other part the column with a usual name, if there is one."""
    bare = {split_unit(name)[0].strip().lower(): name for name in reversed(columns.names)}
    found = dict(given)
    for part, usual in NAMES.items():
        taken = set(found.values())
        match = next((bare[name] for name in usual if name in bare and bare[name] not in taken), None)
        if part not in found and match is not None:
            found[part] = match
    return found


def factor(columns: Columns, part: str, name: str) -> float:
    """Return the factor from the unit of a column to the unit of the bench.

    Raises
    ------
    InputError
        For a unit of something else.
    """
    unit = plain_unit(columns.units.get(name, "")) or split_unit(name)[1] or USUAL[part].lower()
    if unit not in UNITS[part]:
        allowed = ", ".join(UNITS[part])
        said, told = one_line(short(name)), one_line(short(unit))
        raise InputError(f"column {said} is the {part} and has the unit {told}; allowed: {allowed}", "record")
    return UNITS[part][unit]
