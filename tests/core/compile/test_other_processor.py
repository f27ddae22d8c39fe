"""Code for aarch64 gives the bits of this processor: the steps of all blocks, in a C program under an emulator."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core import registry
from core.board import program
from core.board.board import Board
from core.board.parse import parse
from core.compile import code
from core.compile.machine import ARM, LEVELS, compiled
from tests.core.test_conformance import NAMES, block_of, cases, played

TOOLS = COMPILER, COPY, EMULATOR = "aarch64-linux-gnu-gcc", "aarch64-linux-gnu-objcopy", "qemu-aarch64-static"
TARGET = next(level for level in LEVELS if level.triple == ARM)
TICKS, EVERY = 240, 20
AFTER = 130
"""Ticks before the comparison, in which all commands of a story are carried out."""
FULL, WORD = 14695981039346656037, (1 << 64) - 1

pytestmark = pytest.mark.long


def hashed(board: Board) -> str:
    """Return the hash that the program prints."""
    found = FULL
    for bits in np.concatenate([board.wiring.w, board.wiring.s]).view(np.uint64).tolist():
        nan = bits & 0x7FFFFFFFFFFFFFFF > 0x7FF0000000000000
        found = (found ^ (0x7FF8000000000000 if nan else bits)) * 0x100000001B3 & WORD
        found ^= found >> 29
    return f"{found:016x}"


def boards() -> dict[str, Board]:
    """Return boards at a tick after their story, one for each block of the catalogue, by the name of the block."""
    found = {}
    for name in NAMES:
        case: dict[str, Any] = cases(name)[f"{name} step" if name.startswith("faults/") else name]
        board = played(Board(parse(case["bench"])), case)
        board.advance(AFTER)
        if board.trip is None and not len(board.pending):
            found[name] = board
    return found


def numbers_of(board: Board, order: list[type]) -> bytes:
    """Return a board as the program reads it."""
    wiring, table = board.wiring, board.walk.table.copy()
    table[:, program.ADDRESS] = [order.index(wiring.instances[row].block) for row in board.walk.running]
    arrays = wiring.p, wiring.s, wiring.w, wiring.io
    head = [len(table), *map(len, arrays), board.tick, TICKS, EVERY]
    parts = [np.array(head, np.int64), np.array([board.dt_ms]), table, *arrays]
    return b"".join(part.tobytes() for part in parts)


def built(folder: Path, order: list[type]) -> Path:
    """Return the program with the steps of blocks."""
    files = []
    for number, block in enumerate(order):
        piece, file = code.step(block), folder / f"{number}.o"
        file.write_bytes(compiled(piece.write(), TARGET, loops=piece.loops))
        subprocess.run([COPY, f"--redefine-sym=step=step_{number}", file], check=True)
        files.append(file)
    (folder / "steps.h").write_text("\n".join(f"STEP({number})" for number in range(len(order))))
    source = Path(__file__).with_name("other_processor.c")
    options = ["-static", "-O2", "-ffp-contract=off", f"-I{folder}", "-o", folder / "program"]
    subprocess.run([COMPILER, source, *files, *options, "-lm"], check=True)
    return folder / "program"


@pytest.mark.timeout(1800)
@pytest.mark.skipif(not all(map(shutil.which, TOOLS)), reason="Debian has gcc-aarch64-linux-gnu and qemu-user-static")
def test_all_steps_give_the_bits_of_this_processor(tmp_path):
    order = [block for family in registry.FAMILIES for block in registry.blocks(family).values()]
    found = boards()
    assert len(found) > 0.9 * len(NAMES)
    order += list(
        dict.fromkeys(
            board.wiring.instances[row].block
            for board in found.values()
            for row in board.walk.running
            if board.wiring.instances[row].block not in order
        )
    )
    run = {board.wiring.instances[row].block for board in found.values() for row in board.walk.running}
    assert {block_of(name) for name in found} <= run
    (tmp_path / "boards").write_bytes(b"".join(numbers_of(board, order) for board in found.values()))
    path = built(tmp_path, order)
    said = subprocess.run([EMULATOR, path, tmp_path / "boards"], capture_output=True, text=True, check=True).stdout
    lines = said.splitlines()
    assert len(lines) == len(found)
    for (name, board), line in zip(found.items(), lines, strict=True):
        for number, one in enumerate(line.split()):
            board.advance(EVERY)
            if board.trip is not None:
                assert number > 0, name
                break
            assert one == hashed(board), f"{name} after {(number + 1) * EVERY} ticks"
