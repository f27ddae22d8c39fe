"""Work on records of devices, in the processes that compute: it is read, calibrated, diagnosed, put on a bench."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from core.board.document import Document
from core.errors import InputError, unknown
from core.measured_record import MeasuredRecord, record_of
from scenarios.own import beside
from scenarios.records.columns import by_usual_names, split_unit
from scenarios.records.reading import READERS, Pairing, read_record
from scenarios.records.shelf import RecordFolder
from scenarios.schema import Scenario
from server.bench.build import prepare, read_document

if TYPE_CHECKING:  # scipy, which this process may do without
    from scenarios.records.calibration import Calibration

MOST_VERDICTS = 2000
"""Stretches of verdicts that an answer lists for a bank."""


@dataclass(frozen=True)
class RecordMapping:
    """How the columns of a file are to be read.

    Parameters
    ----------
    name : str
        Of the file; its ending says the format.
    named : dict
        Columns of parts, where they have no usual names.
    rate_khz : float, optional
        Of a file without times.
    pairing : {'next', 'last'}
        Whether the voltage of a row acts from its sample on, or acted until it.
    """

    name: str
    named: dict[str, str]
    rate_khz: float | None = None
    pairing: Pairing = "next"


@dataclass(frozen=True)
class TakenIn:
    """A record that was read: its key, and what its row keeps."""

    key: str
    rate_khz: float
    samples: int
    bytes: int
    about: dict[str, Any]


def take_in(upload: Path, mapping: RecordMapping, most_bytes: int) -> TakenIn:
    """Read the file of an upload; its record is written into the same folder, under its key.

    Raises
    ------
    InputError
        Naming row, column and reason, or the size that is allowed.
    """
    with _own_folder(upload.parent):
        read = read_record(
            upload.read_bytes(),
            mapping.name,
            named=mapping.named,
            rate_khz=mapping.rate_khz,
            pairing=mapping.pairing,
        )
    record = read.record
    arrays = [record.drive, record.displacement, *([] if record.label is None else [record.label])]
    size = sum(array.nbytes for array in arrays)
    if size > most_bytes:
        raise InputError(f"its {record.samples} samples take {size} bytes; at most {most_bytes}", "record")
    key = RecordFolder(upload.parent).keep(record)
    about = {
        "columns": read.columns,
        "notes": read.notes,
        "labels": list(record.hypotheses),
        "lost": int(np.isnan(record.displacement).sum()),
        "drive_v": _extremes(record.drive),
        "displacement_um": _extremes(record.displacement),
    }
    return TakenIn(key, record.rate_khz, record.samples, (upload.parent / f"{key}.npz").stat().st_size, about)


def columns_of(upload: Path, name: str) -> dict[str, Any]:
    """Return the columns of a file, and the column of each part that has a usual name.

    Raises
    ------
    InputError
        When it is no table.
    """
    ending = Path(name).suffix.lower()
    if ending not in READERS:
        raise unknown("kind of file", ending or name, READERS, "record")
    with _own_folder(upload.parent):
        columns = READERS[ending](upload.read_bytes())
    return {
        "columns": [
            {"name": one, "unit": columns.units.get(one) or split_unit(one)[1], "is_number": one in columns.numbers}
            for one in columns.names
        ],
        "found": by_usual_names(columns, {}),
    }


@contextmanager
def _own_folder(folder: Path) -> Iterator[None]:
    """Let readers put their temporary files where they are deleted with the upload."""
    before, tempfile.tempdir = tempfile.tempdir, str(folder)
    try:
        yield
    finally:
        tempfile.tempdir = before


def _extremes(column: NDArray[np.float64]) -> list[float]:
    return [float(np.nanmin(column)), float(np.nanmax(column))]


def thinned(record: MeasuredRecord, start: int, end: int, most: int) -> dict[str, list[Any]]:
    """Return the first sample, minimum and maximum of each of at most so many stretches; null: all samples are lost."""
    edges = np.unique(np.linspace(start, end, min(most, end - start) + 1).astype(np.int64))
    found: dict[str, list[Any]] = {"sample": edges[:-1].tolist()}
    for name, column, lost in (("drive", record.drive, False), ("displacement", record.displacement, True)):
        part, places = column[start:end], edges[:-1] - start
        for which, of, nothing in (("low", np.minimum, np.inf), ("high", np.maximum, -np.inf)):
            known = np.where(np.isnan(part), nothing, part) if lost else part
            found[f"{name}_{which}"] = [
                value if np.isfinite(value) else None for value in of.reduceat(known, places).tolist()
            ]
    return found


def record_document(source: str | Document, units: Document, key: str) -> Document:
    """Return the scenario that plays a record with the device of a bench, as a document.

    Raises
    ------
    InputError
        When the record is not kept here, or the bench cannot play any.
    """
    from scenarios.records.bench import on_record

    scenario = _bench(source, units)
    document = on_record(scenario, record_of(key, "record"))
    own = read_document(source).get("units")
    return {**{name: part for name, part in document.items() if name != "units"}, **({"units": own} if own else {})}


def _whole(key: str) -> MeasuredRecord:
    record = record_of(key, "record")
    if not isinstance(record, MeasuredRecord):
        raise InputError("comes from an instrument; send its file when it has ended", "record")
    return record


def calibrated(source: str | Document, units: Document, key: str, first: int, end: int | None) -> dict[str, Any]:
    """Return the calibration of a record, and the values by which any bench gets its device.

    Raises
    ------
    InputError
        For a stretch that cannot calibrate.
    """
    from scenarios.records.calibration import calibrate

    scenario, record = _bench(source, units), _whole(key)
    found = calibrate(record, scenario.spec.nominal, first, _quarter(record, end))
    return {**told(found), "values": {} if found.refusal else _values(scenario, found)}


def diagnosed(source: str | Document, units: Document, key: str, first: int, end: int | None) -> dict[str, Any]:
    """Return the verdicts of the banks of a bench over a record, and its calibration.

    Raises
    ------
    InputError
        For a stretch that cannot calibrate.
    """
    from scenarios.records.diagnosis import as_document, diagnose

    scenario, record = _bench(source, units), _whole(key)
    found = diagnose(record, scenario, first, _quarter(record, end))
    document = as_document(found)
    return {
        "calibration": {
            **told(found.calibration),
            "values": {} if found.refusal else _values(scenario, found.calibration),
        },
        "refusal": found.refusal,
        "banks": [
            {
                "name": name,
                "healthy": found.healthy[name],
                "shares": document["shares"][name],
                "verdicts": verdicts[:MOST_VERDICTS],
                "left_out": max(len(verdicts) - MOST_VERDICTS, 0),
            }
            for name, verdicts in document["verdicts"].items()
        ],
        "figures": document["figures"],
    }


def told(found: Calibration) -> dict[str, Any]:
    """Return a calibration as an answer has it."""
    names = ("mass", "damping", "stiffness", "offset_um", "delay_samples")
    numbers = {name: getattr(found, name) for name in names}
    return {
        **{
            name: {"value": one.value, "error": one.error, "low": one.interval[0], "high": one.interval[1]}
            for name, one in numbers.items()
        },
        "noise_um": found.noise_um,
        "quantum_um": found.quantum_um,
        "samples": found.samples,
        "checks": [vars(one) for one in found.checks],
        "refusal": found.refusal,
    }


def _values(scenario: Scenario, found: Calibration) -> dict[str, float]:
    """Return the values by dotted path that give a bench the calibrated device, and a bench of a record its delay."""
    from scenarios.records.bench import calibrated_device

    device = {**calibrated_device(scenario, found), "force_n_per_v": abs(scenario.spec.device.signed_force_n_per_v)}
    return {
        **{f"device.{name}": value for name, value in device.items()},
        "plant.offset_um": found.offset_um.value,
        "plant.delay_samples": max(found.delay_samples.value, 0.0),
        "sensor.noise_um": found.noise_um,
    }


def _quarter(record: MeasuredRecord, end: int | None) -> int:
    return max(record.samples // 4, 1) if end is None else end


def _bench(source: str | Document, units: Document) -> Scenario:
    return prepare(source, {}, None, partial(beside, units), compiled=False)[0]
