"""User units, from files; each is compiled in a process of its own, with limits of time and memory.

``python -m scenarios.own`` reads a name and a text from standard input, checks and compiles the unit, and ends.
"""

from __future__ import annotations

import inspect
import json
import subprocess
import sys
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from core import registry
from core.board.document import Document
from core.compile import code
from core.compile.machine import WIDTH
from core.errors import InputError, one_line
from core.kernel_cache import get, key, put
from core.own.apart import compile_by
from core.own.unit import Unit, unit
from core.wall import wall
from core.wall.code import kept, name_of
from scenarios.kernel_cache import folder
from scenarios.reading import read_text

MOST_S = 60
"""Time of the processor to compile a unit."""
MOST_WAIT_S = 180
MOST_BYTES = 4 << 30
"""Address space of the process that compiles."""


def compile_apart(name: str, text: str) -> None:
    """Compile a unit in a process of its own, unless it was compiled before.

    Raises
    ------
    InputError
        When that takes too long, too much memory, or fails.
    """
    block = unit(name, text).block
    behind_wall = wall.is_demanded()
    mark = name_of(block) if behind_wall else f"own-{name}-{key(block.step)}"
    if folder() is None or get(mark) is not None:
        return
    command = [sys.executable, "-m", "scenarios.own"]
    told = json.dumps([name, text, behind_wall])
    where = Path(__file__).resolve().parents[1]
    try:
        ended = subprocess.run(
            command, input=told, text=True, capture_output=True, timeout=MOST_WAIT_S, check=False, cwd=where
        )
    except subprocess.TimeoutExpired:
        raise InputError(f"is not compiled after {MOST_WAIT_S} s", f"units.{name}") from None
    if ended.returncode:
        said = one_line(ended.stderr.strip().rpartition("\n")[2])[:200]
        why = said or f"it takes more than {MOST_S} s or {MOST_BYTES >> 30} GB"
        raise InputError(f"cannot be compiled: {why}", f"units.{name}")
    if not behind_wall:
        put(mark, b"")


def with_units(document: Document, files: Iterable[Path], field: str = "--unit") -> Document:
    """Return a document with units from files, each under the name of its file."""
    own = document.get("units", {})
    units = {file.stem: {"source": read_text(file, field)} for file in files}
    if not units or not isinstance(own, dict):  # units that are no table are refused when the document is read
        return document
    return {**document, "units": {**own, **units}}


def beside(units: Document, document: Document) -> Document:
    """Return the units, of some tables by name, that a scenario does not carry itself."""
    own = document.get("units", {})
    return {name: table for name, table in units.items() if name not in own}


@cache
def copies() -> tuple[Unit, ...]:
    """Return the units of the library whose file is a valid user unit without change: texts for a start."""
    found = []
    for family in registry.FAMILIES:
        for name, block in registry.blocks(family).items():
            try:
                one = unit(name, Path(inspect.getfile(block)).read_text("utf-8"))
            except (InputError, OSError, UnicodeDecodeError):
                continue
            if one.family == family:
                found.append(one)
    return tuple(found)


def main() -> None:
    """Compile the unit on standard input."""
    name, text, behind_wall = json.load(sys.stdin)
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_CPU, (MOST_S, MOST_S))
        resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, MOST_BYTES))
    compile_by(None)
    block = unit(name, text).block
    if behind_wall:
        kept(block)  # as WebAssembly alone
    else:
        for width in (1, WIDTH):
            code.step(block, width).kept()


if __name__ == "__main__":
    main()
