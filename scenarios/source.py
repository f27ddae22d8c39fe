"""The document of a scenario from its source, as people name it on the command line and in Python."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import IO, Any

from core.board.document import Document
from core.nesting import read_toml
from scenarios import library
from scenarios.reading import decoded, read_text

Source = str | PathLike[str] | bytes | IO[str] | IO[bytes] | dict[str, Any]


def document_of(source: Source) -> Document:
    """Return the document of a scenario.

    A document is its own source, a path object means its file, bytes and an open file hold TOML. A text means the first
    of these:

    1. an id of the library, whatever files exist;
    2. TOML, if it has several lines;
    3. a path, if it ends in ``.toml`` or exists; ``./first-look`` is a path, ``first-look`` an id;
    4. TOML, if it has an equals sign.

    Raises
    ------
    InputError
        For a file that cannot be read, malformed TOML, or a text that is none of these.
    """
    if isinstance(source, dict):
        return source
    if isinstance(source, PathLike):
        return _of_file(Path(source))
    if isinstance(source, bytes):
        return _of_bytes(source)
    if not isinstance(source, str):
        content = source.read()
        return _of_bytes(content.encode() if isinstance(content, str) else content)
    if source in library.ids():
        return library.get(source).document
    if "\n" in source:
        return read_toml(source, "scenario")
    if source.endswith(".toml") or _exists(source):
        return _of_file(Path(source))
    if "=" in source:
        return read_toml(source, "scenario")
    return library.get(source).document  # which names the nearest id


def _of_bytes(content: bytes) -> Document:
    return read_toml(decoded(content, "it", "scenario"), "scenario")


def _of_file(path: Path) -> Document:
    return read_toml(read_text(path, "scenario"), "scenario", f"TOML in {path}")


def _exists(name: str) -> bool:
    """Whether a file or a folder has this name; a text may be too long for a name."""
    try:
        return Path(name).exists()
    except (OSError, ValueError):
        return False
