"""Makes machine code for levels of processors, which an image or a wheel brings along.

``python -m scenarios.built_kernels`` writes the steps of all blocks, for one board and for boards side by side, and
the kernels that Python calls before the first tick of a scenario of the library. The code for this machine's own levels
is computed with by tests; code for another kind of processor is only written.
"""

from __future__ import annotations

import multiprocessing
import os
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from core import registry
from core.compile import entry
from core.compile.code import Piece, step
from core.compile.machine import LEVELS, compiled
from core.kernel import used
from core.kernel_cache import marked
from scenarios import kernels
from scenarios.edit import with_values
from scenarios.kernel_cache import BUILT
from scenarios.library import get, library
from scenarios.run import build, run

WIDTHS = (1, 8)
"""Boards side by side on the processors of all levels."""
SAMPLES = 600
Task = tuple[str, str, int]


def steps() -> list[Task]:
    """Return the steps of all blocks, by family, name and number of boards."""
    return [(*task, width) for task in kernels.tasks() for width in WIDTHS]


def called() -> list[Piece]:
    """Return the kernels that Python calls from a start to the first figures."""
    kernels.load()
    kernels.loop()
    for scenario in library():
        build(scenario)
    run(with_values(get(kernels.FIRST_BENCH), {"samples": SAMPLES, "expect": []}))
    return [entry.piece(kernel.py_func, kinds) for kernel in used() for kinds in kernel.kinds]


def of_all_levels(piece: Piece) -> dict[str, bytes]:
    """Return the files of a piece of code, by name, one for each level."""
    text = piece.write()
    codes = {piece.name_for(level): compiled(text, level, loops=piece.loops) for level in LEVELS}
    return {name: marked(name, code) for name, code in codes.items()}


def _step(task: Task) -> dict[str, bytes]:
    family, name, width = task
    return of_all_levels(step(registry.block(family, name), width))


def files() -> Iterator[tuple[str, bytes]]:
    """Yield all files, with their names."""
    for piece in called():
        yield from of_all_levels(piece).items()
    method = "fork" if sys.platform == "linux" else "spawn"
    with ProcessPoolExecutor(os.cpu_count(), multiprocessing.get_context(method)) as pool:
        for made in pool.map(_step, steps()):
            yield from made.items()


def write(path: Path = BUILT) -> int:
    """Write the archive; return how many files it has."""
    found = sorted(files())
    part = path.with_suffix(".part")
    with ZipFile(part, "w", ZIP_DEFLATED, compresslevel=9) as archive:
        for name, file in found:
            archive.writestr(ZipInfo(name), file, ZIP_DEFLATED)
    part.replace(path)
    return len(found)


def main() -> None:
    """Write the archive and print its content."""
    count = write()
    levels = ", ".join(f"{level.triple.partition('-')[0]} {level.processor}" for level in LEVELS)
    sys.stdout.write(f"{count} kernels for {levels}: {BUILT.stat().st_size / 1e6:.1f} MB\n")
    sys.stdout.write(
        "aarch64: steps were compared bit for bit in an emulator; kernels that Python calls are untested\n"
    )


if __name__ == "__main__":
    main()
