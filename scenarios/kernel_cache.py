"""Where compiled kernels are kept.

Numba keys its cache on the file of the function it compiles, so an edit in a file that function calls would run
stale code. The folder is therefore named after a hash of all of ``core``.
"""

from __future__ import annotations

import hashlib
import logging
import os
import sys
import tempfile
from functools import cache
from pathlib import Path

CORE = Path(__file__).resolve().parent.parent / "core"


@cache
def core_hash() -> str:
    """Return a hash of every Python file of ``core``."""
    digest = hashlib.sha256()
    for path in sorted(CORE.rglob("*.py")):
        digest.update(path.relative_to(CORE).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def folder() -> Path | None:
    """Return a folder for the cache that can be written, or none."""
    given = os.environ.get("COMBBENCH_KERNEL_CACHE")
    home = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    candidates = (
        [Path(given)] if given else [Path(home) / "combbench", Path(tempfile.gettempdir()) / f"combbench-{os.getuid()}"]
    )
    for candidate in candidates:
        path = candidate / f"kernels-{core_hash()}"
        try:
            path.mkdir(parents=True, exist_ok=True, mode=0o700)
        except OSError:
            continue
        if os.access(path, os.W_OK):
            return path
    return None


def prepare() -> None:
    """Point numba at the cache; without a writable folder kernels are compiled anew at every start."""
    path = folder()
    if path is None:
        logging.getLogger(__name__).warning("no writable folder for compiled kernels; set COMBBENCH_KERNEL_CACHE")
        return
    os.environ["NUMBA_CACHE_DIR"] = str(path)
    if "numba" in sys.modules:
        # numba read its settings before we could; tell it again
        vars(sys.modules["numba"].config)["CACHE_DIR"] = str(path)
