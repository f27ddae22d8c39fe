"""Keeps compiled kernels in a folder."""

from __future__ import annotations

import contextlib
import logging
import os
import stat
import tempfile
import time
import zlib
from functools import cache, cached_property
from io import BytesIO
from pathlib import Path
from zipfile import BadZipFile, ZipFile

from core.kernel_cache import KernelShelf, keep_on

COMPLETE = "complete-"
"""Beginning of the name of the file that marks all kernels of a version as kept."""
KEPT_S = 30 * 24 * 3600.0
"""How long a kernel is kept after its last use."""


class Folder:
    """A folder of compiled kernels, a file for each; several processes may use it."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def get(self, name: str) -> bytes | None:
        """Return a stored kernel; its modification time is the time of its last use."""
        path = self._path / name
        try:
            code = path.read_bytes()
        except OSError:
            return None
        with contextlib.suppress(OSError):
            os.utime(path)
        return code

    def put(self, name: str, code: bytes) -> None:
        """Keep a kernel, whole or not at all."""
        with contextlib.suppress(OSError):
            with tempfile.NamedTemporaryFile(dir=self._path, delete=False) as part:
                part.write(code)
            os.replace(part.name, self._path / name)


BUILT = Path(__file__).with_name("built_kernels.zip")
"""Machine code for levels of processors, made for an image or a wheel; a checkout has none."""


class Built:
    """The machine code of an image or a wheel, for levels of processors; it is trusted like the source beside it."""

    def __init__(self, path: Path = BUILT) -> None:
        self._path = path

    @cached_property
    def _archive(self) -> ZipFile | None:
        try:
            return ZipFile(BytesIO(self._path.read_bytes()))  # forked processes would share the place in a file
        except (OSError, BadZipFile):
            return None

    def get(self, name: str) -> bytes | None:
        """Return a kernel if the archive has it undamaged."""
        try:
            return self._archive.read(name) if self._archive is not None else None
        except (KeyError, BadZipFile, zlib.error):
            return None

    def put(self, name: str, code: bytes) -> None:
        """Keep nothing: what came with a version does not change."""


def prune(path: Path) -> None:
    """Delete the kernels that were unused for a month; a version may miss one of them, so none counts as complete."""
    oldest, pruned = time.time() - KEPT_S, False
    for file in path.iterdir():
        with contextlib.suppress(OSError):  # another process was faster
            if file.stat().st_mtime < oldest:
                file.unlink()
                pruned = True
    if pruned:
        for mark in path.glob(f"{COMPLETE}*"):
            mark.unlink(missing_ok=True)


def user_cache() -> Path:
    """Return the folder of this project in the user's cache."""
    home = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(home) / "combbench"


@cache
def folder() -> Path | None:
    """Return a folder for compiled kernels that can be written, or none."""
    given = os.environ.get("COMBBENCH_KERNEL_CACHE")
    candidates = [Path(given)] if given else [user_cache(), Path(tempfile.gettempdir()) / f"combbench-{os.getuid()}"]
    for candidate in candidates:
        path = candidate / "kernels"
        try:
            path.mkdir(parents=True, exist_ok=True, mode=0o700)
        except OSError:
            continue
        if os.access(path, os.W_OK) and _is_ours(path):
            return path
    return None


def _is_ours(path: Path) -> bool:
    """Say whether no other user can put code into a folder; this process would run it."""
    if os.name != "posix":
        return True
    known = path.stat()
    return known.st_uid == os.getuid() and not known.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def prepare(*, built: bool = True) -> None:
    """Keep compiled kernels; unless told otherwise, also use the kernels of the image or the wheel.

    Without a folder that can be written, what did not come with it is compiled anew at every start.
    """
    path, shelves = folder(), list[KernelShelf]()
    if path is None:
        logging.getLogger(__name__).warning(
            "no folder for compiled kernels that can be written, and by nobody else; set COMBBENCH_KERNEL_CACHE"
        )
    else:
        shelves.append(Folder(path))
    keep_on(*shelves, *([Built()] if built else []))
