"""Columns from files with types: Parquet, MAT and NPZ.

A small file may announce or unpack to any size, so sizes are checked before the columns are read.
"""

from __future__ import annotations

import io
import warnings
import zlib
from collections.abc import Iterator
from typing import Any, cast
from zipfile import ZipFile

import numpy as np

from core.errors import InputError
from scenarios.arrow import pa, pq
from scenarios.records.columns import MOST_NUMBERS, Columns, refuse_large
from scenarios.records.hdf5_table import hdf5_columns
from scenarios.records.vectors import NUMBERS, WORDS, columns_of, unreadable

READ = (
    "double",
    "single",
    "logical",
    "char",
    "cell",
    *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
)
"""Classes of MATLAB that may be columns."""
MOST_UNPACKED = 8 * MOST_NUMBERS
PIECE = 1 << 20
COMPRESSED = 15
"""Type of a compressed element of a MAT file."""


def parquet_columns(content: bytes) -> Columns:
    """Return the columns of a Parquet file; the metadata of a field may name its unit."""
    try:
        file = pq.ParquetFile(io.BytesIO(content))
        schema, rows = file.schema_arrow, file.metadata.num_rows
    except Exception as error:  # a damaged file may raise anything in a foreign reader
        raise unreadable("Parquet", error) from None
    flat = [field for field in schema if _is_number(field.type) or _is_word(field.type)]
    refuse_large(len(schema), 0)
    refuse_large(len(flat), rows)
    columns = Columns(schema.names, {})
    try:
        # words are read as places in a dictionary: a long word that a page repeats is kept once
        words = [field.name for field in flat if _is_word(field.type)]
        reader = pq.ParquetFile(io.BytesIO(content), read_dictionary=words)
        table = reader.read([field.name for field in flat], use_threads=False)
        for field in flat:
            column = table.column(field.name)
            if _is_number(field.type):
                numbers = column.cast(pa.float64()).fill_null(float("nan")).to_numpy()
                columns.numbers[field.name] = np.ascontiguousarray(numbers)
            else:
                columns.words[field.name] = list(_words(column))
    except Exception as error:  # as above
        raise unreadable("Parquet", error) from None
    for field in flat:
        unit = (field.metadata or {}).get(b"unit")
        if unit:
            columns.units[field.name] = unit.decode("utf-8", "replace")
    return columns


def _is_number(kind: Any) -> bool:
    types = pa.types
    return any(of(kind) for of in (types.is_floating, types.is_integer, types.is_boolean, types.is_decimal))


def _is_word(kind: Any) -> bool:
    kind = kind.value_type if pa.types.is_dictionary(kind) else kind
    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind))


def _words(column: Any) -> Iterator[str]:
    """Return words that share the entries of their dictionaries."""
    for chunk in column.chunks:
        packed = chunk if pa.types.is_dictionary(chunk.type) else chunk.dictionary_encode()
        known = [*map(str, packed.dictionary.to_pylist())]
        yield from ("" if at is None else known[at] for at in packed.indices.to_pylist())


def mat_columns(content: bytes) -> Columns:
    """Return the vectors of a MAT file, all of one length; version 7.3 is HDF5."""
    if content.startswith(b"MATLAB 7.3"):
        return hdf5_columns(content)
    from scipy.io import loadmat, whosmat

    try:
        if content.startswith(b"MATLAB 5.0"):
            _refuse_unpacked(content)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of two variables with one name the last counts
            told = whosmat(cast(Any, io.BytesIO(content)))
            chosen = {name: shape for name, shape, kind in told if kind in READ and max(shape, default=0) > 1}
            refuse_large(len(chosen), max((int(np.prod(shape, dtype=float)) for shape in chosen.values()), default=0))
            found: dict[str, Any] = loadmat(cast(Any, io.BytesIO(content)), variable_names=[*chosen])
    except InputError:
        raise
    except Exception as error:  # a damaged file may raise anything in a foreign reader
        raise unreadable("MAT", error) from None
    return columns_of({name: value for name, value in found.items() if name in chosen})


def _refuse_unpacked(content: bytes) -> None:
    """Refuse a MAT file of version 5 whose elements unpack to more than a record may have."""
    order = "<" if content[126:128] == b"IM" else ">"
    at, left = 128, MOST_UNPACKED
    while at + 8 <= len(content):
        kind, size = np.frombuffer(content, f"{order}u4", 2, at).tolist()
        if at + 8 + size > len(content):
            raise InputError(f"announces {size} bytes at byte {at} and has {len(content) - at - 8}", "record")
        if kind == COMPRESSED:
            unpacker, rest = zlib.decompressobj(), content[at + 8 : at + 8 + size]
            while rest and left > 0:
                left -= len(unpacker.decompress(rest, PIECE))
                rest = unpacker.unconsumed_tail
            if left <= 0:
                raise InputError(f"unpacks to more than {MOST_UNPACKED} bytes", "record")
        at += 8 + size


def npz_columns(content: bytes) -> Columns:
    """Return the vectors of an NPZ file, all of one length."""
    vectors = {}
    try:
        with ZipFile(io.BytesIO(content)) as packed:
            refuse_large(len(packed.infolist()), 0)
            for info in packed.infolist():
                with packed.open(info) as file:
                    shape, dtype = _announced(file)
                    if dtype.kind not in NUMBERS + WORDS:
                        continue
                    samples = int(np.prod(shape, dtype=float))
                    refuse_large(len(packed.infolist()), samples * max(dtype.itemsize // 8, 1))
                    if info.file_size < samples * dtype.itemsize:
                        raise ValueError(f"{info.filename} announces {samples} numbers and has fewer")
                with packed.open(info) as file:
                    name = info.filename.removesuffix(".npy")
                    vectors[name] = np.lib.format.read_array(cast(Any, file), allow_pickle=False)
    except InputError:
        raise
    except Exception as error:  # a damaged file may raise anything in a foreign reader
        raise unreadable("NPZ", error) from None
    return columns_of(vectors)


def _announced(file: Any) -> tuple[tuple[int, ...], Any]:
    """Return shape and type in the head of an array."""
    version = np.lib.format.read_magic(file)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, _, dtype = read(file)
    return shape, dtype
