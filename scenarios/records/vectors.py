"""Columns from the arrays of a file that is no table: each vector is one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from core.errors import InputError, one_line, short
from scenarios.records.columns import Columns

NUMBERS, WORDS = "fiub", "US"
"""Kinds of types that are columns."""


def columns_of(arrays: Mapping[str, Any]) -> Columns:
    """Return the vectors among arrays as columns of numbers and words; a matrix is no column.

    Raises
    ------
    InputError
        For no vectors.
    """
    columns = Columns([], {})
    for name, value in arrays.items():
        if value.size < 2 or value.size > max(value.shape):
            continue
        flat = value.reshape(-1)
        if value.dtype.kind in NUMBERS:
            columns.numbers[name] = np.ascontiguousarray(flat, dtype=np.float64)
        elif value.dtype.kind in WORDS or all(map(_is_text, flat.tolist())):
            columns.words[name] = [_text(word) for word in flat.tolist()]
        else:
            continue
        columns.names.append(name)
    if not columns.names:
        raise InputError("has no vectors", "record")
    return columns


def _is_text(word: Any) -> bool:
    """Whether an entry of a cell is a text, as MATLAB keeps it."""
    return isinstance(word, np.ndarray) and word.dtype.kind in WORDS and word.size <= 1


def _text(word: Any) -> str:
    if isinstance(word, np.ndarray):
        return str(word.item()) if word.size else ""
    return word.decode("utf-8", "replace") if isinstance(word, bytes) else str(word)


def unreadable(form: str, error: Exception) -> InputError:
    """Return the refusal of a file that a reader cannot read; the reader may raise anything."""
    return InputError(f"cannot be read as {form}: {one_line(short(str(error), 120))}", "record")
