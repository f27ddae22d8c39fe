"""Compiled code writes its own numbers and nothing beside them: guards around arrays, and all that is not its own."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator

import numpy as np
import pytest

from core import matrix, registry
from core.block import Block
from core.board import program
from core.board.board import CHUNK, Board
from core.board.parse import parse
from tests.core.canaries import Guarded
from tests.core.fence import ENTRY, permitted
from tests.core.test_conformance import NAMES, block_of, cases, played
from tests.lab import RICH, STORY, make, play

AFTER, TICKS = 60, 24


def rows(board: Board, entry: type[Block]) -> Iterator[int]:
    """Yield the rows of a block."""
    yield from (row for row, instance in enumerate(board.wiring.instances) if instance.block is entry)


def board_of(name: str) -> Board:
    """Return a board with a block, at a tick at which its faults act."""
    case = cases(name)[f"{name} step" if name.startswith("faults/") else name]
    board = played(Board(parse(case["bench"])), case)
    board.advance(AFTER)
    return board


def spread(numbers: np.ndarray, width: int) -> np.ndarray:
    """Return numbers of one board as the numbers of boards side by side."""
    return np.repeat(numbers[:, None], width, axis=1)


def strays(board: Board, row: int, width: int) -> list[str]:
    """Run the step of a row, alone, on signals of a running board; return what it wrote beyond its own numbers.

    Of boards side by side each sees the signals of another tick, so that their branches differ.
    """
    wiring = board.wiring
    _, writable = permitted(wiring, row)
    others = np.array(sorted(set(range(len(wiring.w))) - writable))
    function = ENTRY(program.address(wiring.instances[row].block, width))
    p, io = Guarded(spread(wiring.packed(row), width), width), Guarded(wiring.ports(row))
    s, w = (
        Guarded(spread(wiring.state_of(wiring.instances[row].key), width), width),
        Guarded(spread(wiring.w, width), width),
    )
    kept, found = (p.array.copy(), io.array.copy()), list[str]()
    for _ in range(TICKS):
        board.advance(1)
        w.array[:] = np.column_stack([w.array[:, 1:], wiring.w])
        before = w.array[others].tobytes()
        function(*(one.array.ctypes.data for one in (p, s, w, io)))
        if w.array[others].tobytes() != before:
            found.append("a signal of another block")
    found += [f"{name}[{place}]" for name, one in (("p", p), ("s", s), ("w", w), ("io", io)) for place in one.broken()]
    if p.array.tobytes() != kept[0].tobytes() or io.array.tobytes() != kept[1].tobytes():
        found.append("its parameters or places")
    return found


def check(name: str, width: int) -> None:
    board = board_of(name)
    found = {board.wiring.instances[row].key: strays(board, row, width) for row in rows(board, block_of(name))}
    assert found and not any(found.values()), f"{name}: {found}"


@pytest.mark.parametrize("family", registry.FAMILIES)
def test_a_step_writes_its_own_numbers_alone(family):
    for name in (name for name in NAMES if name.startswith(f"{family}/")):
        check(name, 1)


@pytest.mark.long
@pytest.mark.timeout(1200)
@pytest.mark.parametrize("width", [8, 16])
@pytest.mark.parametrize("family", registry.FAMILIES)
def test_a_step_of_boards_side_by_side_writes_its_own_numbers_alone(family, width):
    for name in (name for name in NAMES if name.startswith(f"{family}/")):
        check(name, width)


def test_a_stray_write_is_seen():
    one = Guarded(np.arange(5.0))
    one.array[:] = 1.0
    assert one.broken() == []
    for place in (-1, 5):
        ctypes.c_double.from_address(one.array.ctypes.data + 8 * place).value = 2.0
    assert one.broken() == [-1, 5]


def test_the_loop_writes_rows_folds_states_and_signals_alone():
    straight, board = make({}, STORY, base=RICH), make({}, STORY, base=RICH)
    play(straight, 300)
    wiring = board.wiring
    kept = {name: Guarded(getattr(wiring, name)) for name in ("p", "s", "w", "io")}
    for name, one in kept.items():
        setattr(wiring, name, one.array)
    kept |= {"outputs": Guarded(board._outputs), "taps": Guarded(board._taps), "folds": Guarded(board.folds)}
    board._outputs, board._taps, board.folds = (kept[name].array for name in ("outputs", "taps", "folds"))
    play(board, 300)
    assert len(board._outputs) == CHUNK and board.folds is kept["folds"].array and board.wiring.s is kept["s"].array
    assert board.digest() == straight.digest()
    assert {name: one.broken() for name, one in kept.items() if one.broken()} == {}


def test_kernels_of_matrices_write_results_and_scratch_alone(monkeypatch):
    made: list[Guarded] = []

    def empty(shape, dtype=np.float64):
        made.append(Guarded(np.zeros(shape, dtype)))
        return made[-1].array

    monkeypatch.setattr(np, "empty", empty)
    monkeypatch.setattr(np, "empty_like", lambda array: empty(array.shape))
    system, noise = np.array([[0.9, 0.1, 0.0], [-0.2, 0.8, 0.1], [0.0, -0.1, 0.7]]), np.diag([1.0, 1.0, 1.0])
    matrix.exponential(system)
    matrix.lyapunov(system, noise)
    matrix.riccati(system, system[:1], noise, noise[:1, :1])
    assert len(made) >= 5 and [one.broken() for one in made] == [[]] * len(made)
