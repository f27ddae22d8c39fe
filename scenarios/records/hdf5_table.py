"""Columns from HDF5 and NetCDF files, with the units in their attributes.

Links to other files, and numbers that are computed from other files, are not followed.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from core.errors import InputError
from scenarios.extras import require
from scenarios.records.columns import Columns, refuse_large
from scenarios.records.vectors import NUMBERS, WORDS, columns_of, unreadable

MARK = b"\x89HDF\r\n\x1a\n"
"""The first bytes of an HDF5 file."""


def hdf5_columns(content: bytes) -> Columns:
    """Return the vectors of an HDF5 file; a vector within a group has the path as its name."""
    require("h5py", "files", "record")
    import h5py

    found: dict[str, Any] = {}

    def visit(name: str, one: Any) -> None:
        if isinstance(one, h5py.Dataset) and one.shape and one.dtype.kind in NUMBERS + WORDS:
            if one.external or one.is_virtual:
                raise InputError(f"{name} is in another file", "record")
            refuse_large(len(found) + 1, one.size * max(one.dtype.itemsize // 8, 1))
            found[name] = one

    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            file.visititems(visit)
            vectors = {name: one for name, one in found.items() if one.size == max(one.shape)}
            refuse_large(len(vectors), max((one.size for one in vectors.values()), default=0))
            attributes = {name: dict(one.attrs) for name, one in vectors.items()}
            return _scaled({name: one[()] for name, one in vectors.items()}, attributes)
    except InputError:
        raise
    except Exception as error:  # a damaged file may raise anything in a foreign reader
        raise unreadable("HDF5", error) from None


def netcdf_columns(content: bytes) -> Columns:
    """Return the vectors of a NetCDF file; version 4 is HDF5."""
    if content.startswith(MARK):
        return hdf5_columns(content)
    from scipy.io import netcdf_file

    try:
        with netcdf_file(cast(Any, io.BytesIO(content)), mmap=False) as file:
            refuse_large(len(file.variables), 0)
            arrays = {name: _joined(one.data) for name, one in file.variables.items()}
            attributes = {name: dict(cast(Any, one)._attributes) for name, one in file.variables.items()}
        return _scaled(arrays, attributes)
    except InputError:
        raise
    except Exception as error:  # a damaged file may raise anything in a foreign reader
        raise unreadable("NetCDF", error) from None


def _joined(value: Any) -> Any:
    """Return rows of characters as words."""
    is_rows = value.ndim == 2 and value.dtype == "S1" and value.size
    return np.ascontiguousarray(value).view(f"S{value.shape[1]}")[:, 0] if is_rows else value


def _scaled(arrays: Mapping[str, Any], attributes: Mapping[str, Mapping[str, Any]]) -> Columns:
    """Return vectors as columns: filled places are lost samples, packed numbers are unpacked."""
    columns = columns_of(arrays)
    for name in columns.names:
        about = attributes[name]
        if name in columns.numbers:
            numbers = columns.numbers[name]
            for mark in ("_FillValue", "missing_value"):
                if mark in about:
                    numbers = np.where(arrays[name].reshape(-1) == about[mark], np.nan, numbers)
            scale, offset = (
                float(np.ravel(about.get(key, usual))[0]) for key, usual in (("scale_factor", 1.0), ("add_offset", 0.0))
            )
            columns.numbers[name] = numbers if (scale, offset) == (1.0, 0.0) else numbers * scale + offset
        unit = about.get("units", about.get("unit", ""))
        if isinstance(unit, bytes | str) and unit:
            columns.units[name] = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else unit
    return columns
