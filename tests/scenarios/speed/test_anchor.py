"""The C of a board gives the bits of the board: rows, digest, state, history; a difference is seen and told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from scenarios.speed import boards
from scenarios.speed.anchor import compiler as gcc
from scenarios.speed.anchor import table
from scenarios.speed.anchor.compiler import compiler, libraries, library, version
from scenarios.speed.anchor.difference import same
from scenarios.speed.anchor.pair import OURS, AdvancePair, C, LivePair, StepsPair, TwinPair
from scenarios.speed.anchor.replay import ReplayInC
from scenarios.speed.anchor.table import BENCHES, PAIRS, Anchor, AnchorRow, fused
from scenarios.speed.anchor.text import BoardMoment, board_text

needs_gcc = pytest.mark.skipif(compiler() is None, reason="there is no gcc on this machine")
PARTS = [kind.part for kind in PAIRS]
QUICKLY = "-O0 -ffp-contract=off -shared -fPIC -w".split()


@pytest.fixture(scope="module")
def board():
    return boards.begun(boards.GAIN)


@pytest.fixture(scope="module")
def text(board):
    return board_text([BoardMoment.of(board)])


def run(pair: TwinPair) -> list[str]:
    """Measure a pair once, and return the parts in which board and C differ afterwards."""
    for measure in pair.costs().values():
        assert measure() > 0.0
    return [*pair.differences()]


@needs_gcc
@pytest.mark.parametrize("form", [lambda one: one, fused], ids=["table", "fused"])
def test_the_c_of_a_board_gives_its_bits(form, board, text, tmp_path):
    one, made = form(board), library(str(compiler()), text, tmp_path)
    for kind in PAIRS:
        assert run(kind(one, made)) == [], kind.part


FAULTS = [
    (StepsPair, "if (w[TRIP] != 0.0)", "if (w[TRIP] == 0.0)", "ticks"),
    (StepsPair, "(double)(first + i) * dt_ms", "(double)(first + i) * dt_ms * 1.5", "signals"),
    (AdvancePair, "folds[c] = a ^ (a", "folds[c] = a + (a", "digest"),
    (AdvancePair, "memcpy(rows + i * ROW, w", "memcpy(rows + i * ROW, w + 1", "rows"),
    (LivePair, "ring[k * LANES + c] = x##k", "ring[k * LANES + c] = 2.0f * x##k", "history"),
    (LivePair, "HALVES(LEAST, low)", "HALVES(MOST, low)", "minima"),
    (LivePair, "== FACTOR - 1)", "== FACTOR - 2)", "maxima"),
    (LivePair, "b->steady[g] + n : 0", "b->steady[g] : 1", "idle groups"),
]


@needs_gcc
@pytest.mark.parametrize(("kind", "right", "wrong", "part"), FAULTS, ids=[part for *_, part in FAULTS])
def test_a_fault_in_the_c_is_seen(kind, right, wrong, part, board, text, tmp_path, monkeypatch):
    monkeypatch.setattr(gcc, "FLAGS", QUICKLY)
    assert right in text
    assert part in run(kind(board, library(str(compiler()), text.replace(right, wrong), tmp_path)))


@needs_gcc
def test_c_that_is_no_c_is_refused_with_the_words_of_the_compiler(tmp_path):
    with pytest.raises(RuntimeError, match=r"gcc refuses the C of bench: .*error"):
        libraries(str(compiler()), {"bench": "no C"}, tmp_path)
    assert version(str(compiler())).startswith("gcc ")


@pytest.mark.parametrize(
    ("first", "second", "is_same"),
    [
        ([0.0, np.nan], [0.0, -np.nan], True),
        ([0.0], [-0.0], False),
        ([np.nan], [1.0], False),
        (np.float32([1.0]), np.float32([1.0]), True),
        ([1], [2], False),
    ],
)
def test_arrays_are_the_same_when_all_bits_are_but_those_of_nan(first, second, is_same):
    assert same(np.array(first), np.array(second)) is is_same


def test_without_a_compiler_the_boards_are_measured_alone_and_one_line_says_so(monkeypatch):
    monkeypatch.setattr(table, "compiler", lambda: None)
    monkeypatch.setattr(table, "BENCHES", {"small": lambda: boards.begun(boards.GAIN)})
    anchor = Anchor(rounds=1)
    found = [row.document() for row in anchor.rows()]
    assert [row["part"] for row in found] == [*PARTS, *(f"{part}, fused" for part in PARTS), "whole run"]
    assert all(row["ok"] and row["ours_ns"] > 0.0 and "ratio" not in row for row in found)
    assert anchor.missing == "nothing is measured against C: there is no gcc on this machine"


def test_a_row_has_the_median_of_the_ratios_within_rounds_and_that_of_the_lower_quartiles():
    costs = {OURS: [30.0, 20.0, 40.0, 24.0, 20.0], C: [10.0, 20.0, 20.0, 12.0, 20.0]}
    row = AnchorRow("bench", "steps", 2.0, costs, []).document()
    assert (row["ratio"], row["ratio_of_lower_quartiles"], row["ok"]) == (2.0, 20.0 / 12.0, True)
    assert (row["ours_ns"], row["ours_lower_quartile_ns"], row["c_ns"], row["rounds"]) == (24.0, 20.0, 20.0, 5)
    assert not AnchorRow("bench", "steps", 1.9, costs, []).document()["ok"]


def test_a_row_whose_c_differs_is_not_ok_however_quick_the_board_is():
    row = AnchorRow("bench", "steps", 2.0, {OURS: [1.0], C: [2.0]}, ["digest"]).document()
    assert not row["ok"] and row["differences"] == ["digest"]


@needs_gcc
@pytest.mark.long
@pytest.mark.parametrize("name", BENCHES)
def test_the_c_of_each_measured_bench_gives_its_bits(name, tmp_path):
    board = BENCHES[name]()
    made = library(str(compiler()), board_text([BoardMoment.of(board)]), tmp_path)
    assert [run(kind(one, made)) for one in (board, fused(board)) for kind in PAIRS] == [[]] * 2 * len(PAIRS)


@needs_gcc
@pytest.mark.long
def test_the_seven_steps_in_c_end_with_the_bits_of_the_run(tmp_path: Path):
    replay = ReplayInC()
    replay.library = library(str(compiler()), board_text(replay.moments), tmp_path)
    assert run(replay) == []
    replay.board.wiring.s[0] += 1.0
    assert run(replay) == ["state"]
