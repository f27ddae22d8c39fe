"""One process at a time in a folder: a lock that the system takes back when its holder ends, killed or not."""

from __future__ import annotations

import fcntl
import os
import socket
from pathlib import Path
from typing import IO

from core.errors import InputError

LOCK = ".lock"


def lock(folder: Path, field: str) -> IO[str]:
    """Keep a folder for this process until the file returned is closed.

    Parameters
    ----------
    folder : Path
        An existing folder.
    field : str
        The setting or option that the error names.

    Raises
    ------
    InputError
        When another process has locked it; the error names that process.
    OSError
        When nothing can be written there.
    """
    file = os.fdopen(os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o600), "r+")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        file.truncate()
        file.write(f"process {os.getpid()} on {socket.gethostname()}")
        file.flush()
    except BlockingIOError:
        holder = file.read().strip() or "another process"
        file.close()
        raise InputError(f"{folder} is in use by {holder}", field, "stop that one, or choose another folder") from None
    except OSError:
        file.close()
        raise
    return file
