"""Files of people, read as UTF-8 with or without a byte order mark."""

from __future__ import annotations

from pathlib import Path

from core.errors import InputError


def read_text(path: Path, field: str) -> str:
    """Return the text of a file.

    Raises
    ------
    InputError
        When it cannot be read, or is no text.
    """
    try:
        return path.read_text("utf-8-sig")
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}", field) from None
    except UnicodeDecodeError:
        raise InputError(f"{path} is not UTF-8 text", field) from None
