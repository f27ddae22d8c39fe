"""A scenario by its source: what a person names on the command line or in Python, and where it is read from."""

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

    A document stands for itself, a path object for its file, bytes and an open file for the TOML in them. A text is, in
    this order:

    1. an id of the library, whatever files are there;
    2. TOML, if it has several lines;
    3. a path, if it ends in ``.toml`` or something is there under this name; ``./first-look`` is a file though
       ``first-look`` is an id;
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
    if source.endswith(".toml") or _is_there(source):
        return _of_file(Path(source))
    if "=" in source:
        return read_toml(source, "scenario")
    return library.get(source).document  # which names the nearest id


def _of_bytes(content: bytes) -> Document:
    return read_toml(decoded(content, "it", "scenario"), "scenario")


def _of_file(path: Path) -> Document:
    return read_toml(read_text(path, "scenario"), "scenario", f"TOML in {path}")


def _is_there(name: str) -> bool:
    """Whether there is a file or a folder of a name; a text may be too long for one."""
    try:
        return Path(name).exists()
    except (OSError, ValueError):
        return False
