"""Columns from files with types: Parquet, MAT, NetCDF and HDF5."""

from __future__ import annotations

import io
import tempfile
from typing import Any, cast

import numpy as np

from core.errors import InputError, one_line, short
from scenarios.arrow import pa, pq
from scenarios.extras import require
from scenarios.records.columns import Columns


def parquet_columns(content: bytes) -> Columns:
    """Return the columns of a Parquet file; the metadata of a field may name its unit."""
    try:
        table = pq.read_table(io.BytesIO(content))
    except Exception as error:  # a damaged file may raise anything in a foreign reader
        raise _unreadable("Parquet", error) from None
    columns = Columns(table.column_names, {})
    for field in table.schema:
        column = table.column(field.name)
        if pa.types.is_floating(field.type) or pa.types.is_integer(field.type):
            numbers = column.cast(pa.float64()).fill_null(float("nan")).to_numpy()
            columns.numbers[field.name] = np.ascontiguousarray(numbers)
        else:
            columns.words[field.name] = ["" if word is None else str(word) for word in column.to_pylist()]
        unit = (field.metadata or {}).get(b"unit")
        if unit:
            columns.units[field.name] = unit.decode("utf-8", "replace")
    return columns


def mat_columns(content: bytes) -> Columns:
    """Return the vectors of a MAT file up to version 7, all of one length."""
    from scipy.io import loadmat

    try:
        found: dict[str, Any] = loadmat(cast(Any, io.BytesIO(content)))
    except Exception as error:  # a damaged file may raise anything in a foreign reader
        raise _unreadable("MAT", error) from None
    vectors = {
        name: value for name, value in found.items() if not name.startswith("__") and isinstance(value, np.ndarray)
    }
    return _of_vectors({name: value for name, value in vectors.items() if value.size > 1 or value.dtype.kind in "US"})


def netcdf_columns(content: bytes) -> Columns:
    """Return the vectors of a NetCDF or HDF5 file, with the units in its attributes."""
    require("xarray", "data", "record")
    import xarray

    try:
        with tempfile.NamedTemporaryFile(suffix=".nc") as file:
            file.write(content)
            file.flush()
            with xarray.open_dataset(file.name, decode_times=False) as data:
                vectors = {str(name): np.asarray(data[name].values) for name in data.variables}
                units = {
                    str(name): str(data[name].attrs["units"]) for name in data.variables if "units" in data[name].attrs
                }
    except Exception as error:  # a damaged file may raise anything in a foreign reader
        raise _unreadable("NetCDF or HDF5", error) from None
    columns = _of_vectors(vectors)
    columns.units = units
    return columns


def _of_vectors(vectors: dict[str, Any]) -> Columns:
    """Return numbers and words of one length as columns; a matrix of samples is taken column by column."""
    columns = Columns([], {})
    for name, value in vectors.items():
        flat = value.reshape(-1) if 1 in value.shape or value.ndim == 1 else None
        if flat is None:
            continue
        columns.names.append(name)
        if value.dtype.kind in "fiub":
            columns.numbers[name] = np.ascontiguousarray(flat, dtype=np.float64)
        else:
            columns.words[name] = [str(word) for word in flat.tolist()]
    if not columns.names:
        raise InputError("has no vectors", "record")
    return columns


def _unreadable(form: str, error: Exception) -> InputError:
    return InputError(f"cannot be read as {form}: {one_line(short(str(error), 120))}", "record")
