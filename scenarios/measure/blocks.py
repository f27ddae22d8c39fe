"""Long columns, block by block: numpy adds up a block, and blocks are added in their order.

The bits of a sum do not depend on the sizes of the pieces, and a column in a temporary file is never in memory as a
whole.
"""

from __future__ import annotations

import mmap
from collections.abc import Callable, Iterable, Iterator
from typing import Any, cast

import numpy as np

from core.block import FloatArray, IntArray
from core.kernel import kernel

BLOCK = 1 << 16
"""Samples of a block."""
ALL = slice(None)


def loaded(column: FloatArray, at: IntArray | slice = ALL) -> FloatArray:
    """Return samples of a column in memory; samples of a temporary file are read, and their pages are released."""
    if not isinstance(column, np.memmap):
        return column if at is ALL else column[at]
    read = np.array(column[at])
    cast(Any, column)._mmap.madvise(mmap.MADV_DONTNEED)
    return read


def blocks(*columns: FloatArray, more: int = 0) -> Iterable[list[FloatArray]]:
    """Return the blocks of columns of one length, each extended by some samples of the next."""
    length = len(columns[0])
    if length <= BLOCK:  # as most columns are
        return ([loaded(column) for column in columns],)
    return ([loaded(column[at : at + BLOCK + more]) for column in columns] for at in range(0, length, BLOCK))


def total(of: Callable[..., Any], *columns: FloatArray) -> Any:
    """Return the sum of the results of a function over the blocks of columns."""
    found = None
    for block in blocks(*columns):
        now = np.sum(of(*block))
        found = now if found is None else found + now
    return 0.0 if found is None else found


def mean(column: FloatArray) -> float:
    """Return the mean."""
    return float(total(np.asarray, column) / len(column))


def largest(of: Callable[..., Any], *columns: FloatArray) -> float:
    """Return the largest value of a function of columns; nan where one is nan."""
    return float(np.max([np.max(of(*block)) for block in blocks(*columns)]))


def width(column: FloatArray) -> float:
    """Return the distance of the largest number from the smallest."""
    return largest(np.asarray, column) + largest(np.negative, column)


def is_zero(column: FloatArray) -> bool:
    """Say whether all numbers are 0."""
    return not any(np.any(block) for (block,) in blocks(column))


def last_where(of: Callable[..., Any], *columns: FloatArray) -> int:
    """Return the samples to the last one at which a condition holds; 0 if it never does."""
    found = 0
    for number, block in enumerate(blocks(*columns)):
        holds = np.flatnonzero(of(*block))
        found = number * BLOCK + int(holds[-1]) + 1 if len(holds) else found
    return found


def first_where(of: Callable[..., Any], *columns: FloatArray) -> int:
    """Return the samples before the first one at which a condition holds; all of them if it never does."""
    for number, block in enumerate(blocks(*columns)):
        holds = np.flatnonzero(of(*block))
        if len(holds):
            return number * BLOCK + int(holds[0])
    return len(columns[0])


def stretches(column: FloatArray) -> Iterator[int]:
    """Yield 0, and the samples at which a column takes another value."""
    yield 0
    for number, (block,) in enumerate(blocks(column, more=1)):
        found = np.empty(len(block), dtype=np.int64)
        yield from (number * BLOCK + found[: _steps(block, found)]).tolist()


@kernel
def _steps(column: FloatArray, found: IntArray) -> int:
    """Write the samples that differ from the sample before; return how many they are."""
    count = 0
    for i in range(1, len(column)):
        if column[i] != column[i - 1]:
            found[count] = i
            count += 1
    return count
