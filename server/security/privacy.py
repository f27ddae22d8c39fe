"""Keeps the files of the service readable by its own user alone."""

from __future__ import annotations

import logging
import os
import tempfile
from pathlib import Path

log = logging.getLogger(__name__)

KEPT = ("token*", "lti-key.pem*", "combbench.sqlite3*", "recordings", "records", "runs", "units")
OTHERS = 0o077


def keep_private(data: Path) -> None:
    """Make the data folder if there is none, and make its old and its new files readable by its owner alone.

    An existing folder keeps its mode, because it may also hold files of others.

    Parameters
    ----------
    data : Path
        The data folder.
    """
    os.umask(OTHERS)
    data.mkdir(parents=True, exist_ok=True)
    for path in (path for pattern in KEPT for path in data.glob(pattern)):
        mode = path.stat().st_mode
        if mode & OTHERS:
            try:
                path.chmod(mode & ~OTHERS & 0o7777)
            except PermissionError:  # as on a volume of another owner
                log.warning("%s may be read by others, and is not this user's to change", path)


def write_private(path: Path, content: bytes) -> None:
    """Write a file that its owner alone can read; whatever ends the process, it is whole or as it was before."""
    path.parent.mkdir(parents=True, exist_ok=True)
    descriptor, part = tempfile.mkstemp(dir=path.parent, prefix=f"{path.name}.")  # for the owner alone
    with os.fdopen(descriptor, "wb") as file:
        file.write(content)
    os.replace(part, path)
