"""Names the folder in which compiled kernels are kept."""

from __future__ import annotations

import logging
import os
import tempfile
from pathlib import Path

from core.kernel_cache import keep_in


def folder() -> Path | None:
    """Return a folder for compiled kernels that can be written, or none."""
    given = os.environ.get("COMBBENCH_KERNEL_CACHE")
    home = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    candidates = (
        [Path(given)] if given else [Path(home) / "combbench", Path(tempfile.gettempdir()) / f"combbench-{os.getuid()}"]
    )
    for candidate in candidates:
        path = candidate / "kernels"
        try:
            path.mkdir(parents=True, exist_ok=True, mode=0o700)
        except OSError:
            continue
        if os.access(path, os.W_OK):
            return path
    return None


def prepare() -> None:
    """Keep compiled kernels; without a writable folder they are compiled anew at every start."""
    path = folder()
    if path is None:
        logging.getLogger(__name__).warning("no writable folder for compiled kernels; set COMBBENCH_KERNEL_CACHE")
        return
    keep_in(str(path))
