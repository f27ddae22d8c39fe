r"""Folds a trace into 128 bits per column; every bit of every sample changes them.

A column has two words. With :math:`x` the 64 bits of the new sample,

.. math:: a \leftarrow S_{32}\bigl((a \oplus x)\,M_a\bigr), \qquad b \leftarrow S_{29}\bigl((b + x)\,M_b\bigr),
          \qquad S_n(z) = z \oplus \lfloor z / 2^n \rfloor

modulo :math:`2^{64}`, with odd factors. Each is one-to-one in the word and in the sample, so two columns that differ in
one sample never fold alike. All NaN count as the same sample, since machines give them different bits. The
fold does not withstand a search for collisions; the SHA-256 over all folds only makes one short text of them.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from core.block import IntArray
from core.kernel import kernel

Words = NDArray[np.uint64]

START = np.array([[0x9E3779B97F4A7C15], [0xC2B2AE3D27D4EB4F]], dtype=np.uint64)
FACTOR_A, FACTOR_B = np.uint64(0xFF51AFD7ED558CCD), np.uint64(0xD6E8FEB86659FD93)
S32, S29 = np.uint64(32), np.uint64(29)
A, B, WORD = int(FACTOR_A), int(FACTOR_B), 2**64 - 1
SHIFTS = int(S32), int(S29)
INFINITE, UNSIGNED, NO_NUMBER = np.uint64(0x7FF0 << 48), np.uint64(2**63 - 1), np.uint64(0x7FF8 << 48)
"""Bits of infinity, all but the sign, and the bits that every NaN is taken for."""
NONE = int(INFINITE), int(UNSIGNED), int(NO_NUMBER)


def begin(columns: int) -> Words:
    """Return the folds of columns without a sample, shape (2, columns)."""
    return np.repeat(START, columns, axis=1)


@kernel
def fold(folds: Words, samples: Words) -> None:
    """Fold one sample into each column.

    Parameters
    ----------
    folds : ndarray of uint64, shape (2, columns)
        Changed in place.
    samples : ndarray of uint64, shape (columns or more,)
        The bits of the samples.
    """
    for c in range(folds.shape[1]):
        x = NO_NUMBER if samples[c] & UNSIGNED > INFINITE else samples[c]
        a = (folds[0, c] ^ x) * FACTOR_A
        b = (folds[1, c] + x) * FACTOR_B
        folds[0, c] = a ^ (a >> S32)
        folds[1, c] = b ^ (b >> S29)


def alike(samples: Words) -> Words:
    """Return the bits of samples, the same for every NaN."""
    return np.where(samples & UNSIGNED > INFINITE, NO_NUMBER, samples)


def digest(folds: Words, blocks: Sequence[str]) -> str:
    """Return the SHA-256 over the folds of all blocks, in the order of their names.

    Parameters
    ----------
    folds : ndarray of uint64, shape (2, columns)
        The folds of every column.
    blocks : sequence of str
        The block of each column; empty for a column that does not count.
    """
    names, owners = _owners(tuple(blocks))
    words = np.repeat(START.T, len(names), axis=0)
    join(folds, owners, words)
    sha = hashlib.sha256()
    for name, own in zip(names, words.astype("<u8"), strict=True):
        sha.update(name + b"\0" + own.tobytes())
    return sha.hexdigest()


@lru_cache(maxsize=64)
def _owners(blocks: tuple[str, ...]) -> tuple[list[bytes], IntArray]:
    """Return the names of the blocks that count, in order, and the number of each column's among them, -1 for none."""
    names = sorted({*blocks} - {""})
    return [name.encode() for name in names], np.array([names.index(name) if name else -1 for name in blocks], np.int64)


@kernel
def join(folds: Words, owners: IntArray, words: Words) -> None:
    """Fold the folds of the columns of each block into one, in their order.

    Parameters
    ----------
    folds : ndarray of uint64, shape (2, columns)
        The folds of every column.
    owners : ndarray of int64, shape (columns,)
        The block of each column, below 0 for none.
    words : ndarray of uint64, shape (blocks, 2)
        The words of each block, which the caller has begun; changed in place.
    """
    for column in range(len(owners)):
        own = owners[column]
        if own >= 0:
            for k in range(2):
                word = folds[k, column]
                a, b = (words[own, 0] ^ word) * FACTOR_A, (words[own, 1] + word) * FACTOR_B
                words[own, 0], words[own, 1] = a ^ (a >> S32), b ^ (b >> S29)
