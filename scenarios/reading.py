"""Files of people: read as UTF-8 with or without a byte order mark, and the address of their JSON Schema."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from core.errors import InputError

ADDRESS = "$schema"
"""The key of JSON in which a document names its JSON Schema, for editors."""


def without_address(document: dict[str, Any]) -> dict[str, Any]:
    """Return a document without the address of its JSON Schema, on which no result depends."""
    if not isinstance(document.get(ADDRESS), str):
        return document
    return {key: value for key, value in document.items() if key != ADDRESS}


def schema_line(name: str) -> str:
    """Return the first line of a document that is written: the file of its JSON Schema, for editors.

    It names a file beside the document, as ``combbench schema NAME --out FOLDER`` writes it. The address of a server
    would differ from host to host, ask for a token, and end with the server.
    """
    return f"#:schema ./{schema_file(name)}\n"


def schema_file(name: str) -> str:
    """Return the name of the file of a JSON Schema."""
    return f"{name}.schema.json"


def read_text(path: Path, field: str) -> str:
    """Return the text of a file.

    Raises
    ------
    InputError
        When it cannot be read, or is no text.
    """
    return decoded(read_bytes(path, field), str(path), field)


def read_bytes(path: Path, field: str, most: int | None = None) -> bytes:
    """Return the bytes of a file, at most so many.

    Raises
    ------
    InputError
        When it cannot be read, or is larger.
    """
    try:
        if most is not None and path.stat().st_size > most:
            raise InputError(f"{path} has more than {most} bytes", field)
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}", field) from None


def decoded(content: bytes, name: str, field: str) -> str:
    """Return the text in the bytes of a file, with line ends as on Unix.

    Raises
    ------
    InputError
        When it is no text.
    """
    try:
        return content.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        raise InputError(f"{name} is not UTF-8 text", field) from None
