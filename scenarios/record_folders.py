"""The folders of records in which benches look for them: of the environment, and of the servers of this process."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

FOLDER = "COMBBENCH_RECORDS"
"""Variable of the environment that names the folder, or several."""
BETWEEN = "\n"
"""Between two folders of the variable: a colon may be part of a name."""
_in_use: list[str | None] = []
"""The folder of before, and the folders of the servers that run in this process."""


@contextmanager
def found_by_benches(folder: Path) -> Iterator[None]:
    """Let the benches of this process, and the processes that it starts, find the records of a server."""
    own = str(folder.resolve())
    if not _in_use:
        _in_use.append(os.environ.get(FOLDER))
    _in_use.append(own)
    os.environ[FOLDER] = own
    try:
        yield
    finally:
        _in_use.remove(own)
        if (newest := _in_use[-1]) is None:
            os.environ.pop(FOLDER, None)
        else:
            os.environ[FOLDER] = newest
        if len(_in_use) == 1:
            _in_use.clear()


def folders() -> list[str]:
    """Return the folders: of the environment, then of the servers that run in this process."""
    named = os.environ.get(FOLDER, "").split(BETWEEN)
    return [*dict.fromkeys(folder for folder in (*named, *_in_use[1:]) if folder)]


def use(found: list[str]) -> None:
    """Let this process look in these folders."""
    os.environ[FOLDER] = BETWEEN.join(found)
