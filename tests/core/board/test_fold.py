"""The digest of a run: every bit of the outputs of a bench counts, and blocks in shadow do not."""

from __future__ import annotations

import ctypes
import hashlib
import math
import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn

from core import registry
from core.board import fold
from core.board.board import Board
from core.compile.folding import folding
from core.compile.machine import WIDTH
from core.control.open_loop import OpenLoop
from core.kernel import kernel
from core.own.guarded import signed
from core.plain import plain
from core.ports import RESERVED
from core.record import BLANK_BITS
from tests import lab

NONES = (
    0x7FF8 << 48,
    0xFFF8 << 48,
    0x7FF8 << 48 | 1,
    0xFFF0 << 48 | 1,
    0x7FF0 << 48 | 2**51 - 1,
    2**64 - 1,
    BLANK_BITS,
)
"""Bits of numbers that are none: quiet and signalling, of either sign, with any payload."""
WORDS = stn.arrays(np.uint64, st.tuples(st.integers(1, 6), st.integers(1, 4)))
PRIME = 2**64


def folded(rows: np.ndarray[Any, Any]) -> fold.Words:
    """Fold rows of float64 or of words, as the compiled loop does."""
    folds = fold.begin(rows.shape[1])
    for row in rows:
        fold.fold(folds, np.ascontiguousarray(row).view(np.uint64))
    return folds


def in_python(folds: fold.Words, samples: fold.Words) -> None:
    """Fold a sample in plain Python."""
    with np.errstate(over="ignore"):
        plain(fold.fold)(folds, samples)


@given(WORDS)
def test_it_is_the_formula(rows: np.ndarray[Any, Any]) -> None:
    """In whole numbers without a bound, taken modulo 2^64; the same text uncompiled gives the same."""
    words = fold.begin(rows.shape[1])
    for row in rows:
        in_python(words, row)
    np.testing.assert_array_equal(folded(rows), words)
    for column in range(rows.shape[1]):
        a, b = 0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F
        for x in map(int, rows[:, column]):
            x = 0x7FF8 << 48 if np.isnan(np.array(x, np.uint64).view(np.float64)) else x
            a = (a ^ x) * 0xFF51AFD7ED558CCD % PRIME
            b = (b + x) % PRIME * 0xD6E8FEB86659FD93 % PRIME
            a, b = a ^ a >> 32, b ^ b >> 29
        assert tuple(map(int, words[:, column])) == (a, b)


@given(WORDS, st.integers(0, 10**6), st.integers(0, 63))
def test_every_bit_counts(rows: np.ndarray[Any, Any], place: int, bit: int) -> None:
    other = rows.copy()
    other.flat[place % rows.size] ^= np.uint64(1 << bit)
    assume(not np.isnan(rows.view(np.float64)).any() and not np.isnan(other.view(np.float64)).any())
    changed = (folded(rows) != folded(other)).any(axis=0)
    assert changed.sum() == 1 and changed[place % rows.size % rows.shape[1]]
    # one-to-one: both words differ
    assert (folded(rows) != folded(other)).sum() == 2


def test_order_columns_signs_and_what_is_no_number_count() -> None:
    rows = np.random.default_rng(1).normal(size=(50, 3))

    def digest(values: np.ndarray[Any, Any]) -> str:
        return fold.digest(folded(values), ["a"] * 3)

    swapped, turned, later = rows.copy(), rows[:, [1, 0, 2]], rows.copy()
    swapped[[10, 11]] = swapped[[11, 10]]
    later[20, 0], later[20, 1] = rows[20, 1], rows[20, 0]
    empty = [np.zeros((50, 3)), -np.zeros((50, 3)), np.zeros((51, 3))]
    none, infinite, less = rows.copy(), rows.copy(), rows.copy()
    none[7, 2], infinite[7, 2], less[7, 2] = np.nan, np.inf, -np.inf
    all_of_them = [rows, swapped, turned, later, *empty, none, infinite, less]
    assert len({digest(values) for values in all_of_them}) == len(all_of_them)


def test_all_that_is_no_number_counts_as_one() -> None:
    """Compiled, in plain numpy and abreast; machines give such a number different bits."""
    numbers = [np.array(bits, np.uint64) for bits in NONES]
    assert all(np.isnan(bits.view(np.float64)) for bits in numbers)
    plain, found, wide = set(), set(), np.repeat(fold.begin(1)[:, :, None], WIDTH, axis=2)
    sizes, place = np.array([1, 1], np.int64), np.array([RESERVED], np.int64)
    address = folding((fold.A, fold.B), fold.SHIFTS, fold.NONE, RESERVED)
    for bits in numbers:
        row = bits.reshape(1, 1)
        folds = fold.begin(1)
        in_python(folds, row[0])
        plain.add(folds.tobytes())
        found.add(folded(row).tobytes())
        w, folds = np.full((RESERVED + 1, WIDTH), bits), wide.copy()
        ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(address)(*(one.ctypes.data for one in (w, folds, place, sizes)))
        assert {folds[:, :, lane].tobytes() for lane in range(WIDTH)} == found
    assert len(found) == 1 and plain == found


def test_the_sign_of_no_number_reaches_no_number() -> None:
    sizes = [float(np.array(bits, np.uint64).view(np.float64)) for bits in NONES]
    for step in (signed_of, plain(signed_of)):
        assert all(math.isnan(step(sign)) for sign in sizes)
    assert signed_of(-0.0) == -2.0 and signed_of(0.0) == 2.0 == signed_of(math.inf)


@kernel
def signed_of(sign: float) -> float:
    return signed(2.0, sign)


def test_blocks_are_joined_by_name() -> None:
    a, b = (folded(np.random.default_rng(seed).normal(size=(9, 2))) for seed in (1, 2))
    both = np.hstack([a, b])
    assert fold.digest(both, [*"aabb"]) == fold.digest(np.hstack([b, a]), [*"bbaa"])
    assert fold.digest(both, [*"aabb"]) == fold.digest(both[:, [0, 2, 1, 3]], [*"abab"])
    assert fold.digest(both, [*"aabb"]) != fold.digest(both, [*"bbaa"])
    words = [int(word) for word in fold.START[:, 0]]
    for word in (int(word) for column in a.T for word in column):
        words = [(words[0] ^ word) * fold.A % 2**64, (words[1] + word) * fold.B % 2**64]
        words = [words[0] ^ words[0] >> 32, words[1] ^ words[1] >> 29]
    alone = hashlib.sha256(b"a\0" + struct.pack("<QQ", *words)).hexdigest()
    assert fold.digest(a, [*"aa"]) == fold.digest(both, ["a", "a", "", ""]) == alone


def test_the_digest_is_of_the_trace() -> None:
    """Folded anew from the rows of the trace, by the definition."""
    board = lab.make(base=lab.RICH)
    traces = lab.play(board, 300)
    outputs = [signal for signal in board.signals if signal.kind == "output"]
    aside = set(board.spec.controllers) - {"open_loop"}
    blocks = ["" if signal.block in aside else signal.block for signal in outputs]
    assert board.digest() == fold.digest(folded(np.column_stack([traces[signal.name] for signal in outputs])), blocks)


def test_chunks_and_copies_do_not_matter() -> None:
    whole = lab.run_digest(lab.make(commands=lab.STORY, base=lab.RICH), 700)
    board = lab.make(commands=lab.STORY, base=lab.RICH)
    for ticks in (1, 99, 300):
        lab.play(board, ticks)
    kept = board.checkpoint()
    lab.play(board, 300)
    assert board.digest() == whole
    assert lab.run_digest(Board.restore(kept), 300) == whole
    assert lab.run_digest(Board.restore(kept), 299) != whole


def test_a_controller_counts_once_it_drives() -> None:
    """Its whole past counts then, so a controller in shadow changes nothing until it drives."""
    other = {"controllers.pid.integral_v_um_ms": 0.01}
    assert lab.run_digest(lab.make(), 200) == lab.run_digest(lab.make(other), 200)
    switch = {"switch": "pid", "at_sample": 150}
    later = {"switch": "pid", "at_sample": 201}
    never = {"switch": "pid", "when": "plant.displacement > 1000"}
    plain = lab.run_digest(lab.make(), 200)
    assert lab.run_digest(lab.make(commands=[later]), 200) == plain
    assert lab.run_digest(lab.make(commands=[never]), 200) == plain
    assert lab.run_digest(lab.make(commands=[switch]), 200) != plain
    assert lab.run_digest(lab.make(commands=[switch]), 150) == lab.run_digest(lab.make(), 150)
    # back again at the same tick: it has not driven
    back = {"switch": "open_loop", "at_sample": 150}
    assert lab.run_digest(lab.make(commands=[switch, back]), 200) == plain


def test_a_controller_more_in_the_catalogue_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    before = [lab.run_digest(lab.make(base=base), 300) for base in (lab.QUIET, lab.RICH)]

    class DoNothing(OpenLoop):
        """A controller that does nothing."""

    DoNothing.name, DoNothing.family = "do_nothing", "control"
    monkeypatch.setitem(registry.blocks("control"), "do_nothing", DoNothing)
    boards = [lab.make(base=base) for base in (lab.QUIET, lab.RICH)]
    assert all("do_nothing" in board.spec.controllers for board in boards)
    assert [lab.run_digest(board, 300) for board in boards] == before
