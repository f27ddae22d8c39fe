"""Compiles the kernels that are not kept yet, on all cores.

``python -m scenarios.kernels`` prints its progress, then deletes the kernels that were unused for a month.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

import numpy as np

from core import registry
from core.board import abreast, fold, kept, program
from core.board.history import History
from core.board.rows import Rows
from core.board.wiring import wire
from core.compile import code
from core.compile.keeping import SLICE
from core.compile.machine import WIDTH
from core.ports import RESERVED
from scenarios.kernel_cache import COMPLETE, folder, prepare, prune
from scenarios.key import code_version
from scenarios.library import get
from scenarios.run import build

HEAVY_FIRST = ("plant", "diagnose", "identify", "control", "sense", "board", "faults", "reference", "rate", "readout",
               "supervise")  # fmt: skip
"""Families in the order of compilation, so that no core still has a long one at the end."""
FIRST_BENCH = "first-look"
NICE = 10
"""How far compiling steps back behind benches that run."""
LINE_EVERY = 10
"""Kernels from one line of progress to the next, where there is no terminal to write over the last one."""
LOOP = ("", "loop")
"""The task that compiles the kernels every bench needs besides its blocks."""

Task = tuple[str, str]


def load() -> None:
    """Load the kernels of a bench, or compile them, and compute one tick with them."""
    board = build(get(FIRST_BENCH))
    history = History(board.signals.outputs, len(board.signals.taps), 1)
    board.advance_into(history, 1)
    history.append(board.advance(1))
    history.columns([0], 0, 1, 1)


def loop() -> None:
    """Compile the loop and the history, with a run of no ticks and no blocks."""
    none, nothing = np.zeros(RESERVED), np.zeros((0, 0))
    table, folds, watches = np.zeros((0, program.COLUMNS), np.int64), fold.begin(0), np.zeros((0, 3))
    program.run(0, 0, 1.0, table, none, none, none, np.zeros(0, np.int64), nothing, nothing, folds, 0, watches)
    wide, no, wide_folds = np.zeros((RESERVED, WIDTH)), np.zeros(0, np.int64), np.zeros((2, 0, WIDTH), np.uint64)
    trace = 0, 0, np.zeros((SLICE, 0, WIDTH)), no, np.zeros((0, WIDTH, 0)), no, no
    abreast.run(0, 0, 1.0, table, wide, wide, wide, no, 0, wide_folds, no, no, *trace, 0, 1)
    history = History(1, 1, 1)
    history.append(Rows.of(0, np.zeros((1, 2)), 1))
    arrays, resting = (table, none, none, none, no), np.zeros(2, np.bool_)
    kept.run(0, 0, 1.0, *arrays, 1, fold.begin(1), 0, watches, no, np.zeros(0), *history.rings, resting)
    history.columns([0], 0, 1, 1)
    history.read([0], 0, 1)


def tasks(*, first_bench_only: bool = False) -> list[Task]:
    """Return the blocks that have a kernel, by family and name, with the slowest to compile first."""
    if first_bench_only:
        spec = get(FIRST_BENCH).spec
        wiring = wire(spec)
        blocks = [wiring.instances[row].block for row in wiring.rest(spec)]
        named = {(block.family, block.name) for block in blocks}
        return [task for task in tasks() if task in named]
    return [(family, name) for family in HEAVY_FIRST for name in registry.blocks(family)]


def compile_all(work: list[Task], told: Callable[[int, int], None], *, abreast: bool = True) -> None:
    """Compile some kernels in processes of their own, also for boards abreast; report the progress."""
    method = "fork" if sys.platform == "linux" else "spawn"
    with ProcessPoolExecutor(os.cpu_count(), multiprocessing.get_context(method)) as pool:
        done = [pool.submit(_compile, task, abreast) for task in [LOOP, *work]]
        for count, future in enumerate(as_completed(done), 1):
            future.result()
            told(count, len(done))


def _compile(task: Task, abreast: bool) -> None:
    family, name = task
    if task == LOOP:
        loop()
        return
    block = registry.block(family, name)
    for width in (1, WIDTH) if abreast else (1,):
        code.step(block, width).kept()


def complete() -> Path | None:
    """Return the file that marks all kernels of this version as kept, or None where no kernels are kept."""
    path = folder()
    return path / f"{COMPLETE}{code_version()}" if path is not None else None


def main() -> None:
    """Compile all kernels; ``first``: only for the first bench, ``behind``: at lower priority than running benches."""
    start = time.monotonic()
    first = "first" in sys.argv
    if not first:
        prepare(built=False)  # all are compiled for this very processor
    if "behind" in sys.argv and os.name == "posix":
        os.nice(NICE)

    terminal = sys.stdout.isatty()

    def told(count: int, total: int) -> None:
        if terminal or count % LINE_EVERY == 0 or count == total:
            time_taken = f", {time.monotonic() - start:.1f} s" if count == total else ""
            text = f"Compiling kernels: {count} of {total}{time_taken}"
            sys.stdout.write(f"\r{text}" if terminal else f"{text}\n")
            sys.stdout.flush()

    compile_all(tasks(first_bench_only=first), told, abreast=not first)
    if terminal:
        sys.stdout.write("\n")
    done = complete()
    if done is not None and not first:
        prune(done.parent)  # the kernels of this version have just been used
        done.touch()


if __name__ == "__main__":
    main()
