"""Lab sheets: Markdown with steps that the server checks; one file each, shown next to the bench."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from core.errors import unknown
from scenarios.sheets.check import check
from scenarios.sheets.sheet import Sheet

ORDER = (
    "first-look",
    "resonance-and-q",
    "pid-against-mrac",
    "variable-structure",
    "identification",
    "kalman-and-noise",
    "forgetting",
    "blind-diagnosis",
)
"""The sheets in the order in which they are taught; any other comes behind."""


@cache
def ids() -> tuple[str, ...]:
    """Return the id of every sheet of the library; it names the file."""
    names = [file.name.removesuffix(".md") for file in files(__name__).iterdir() if file.name.endswith(".md")]
    return tuple(sorted(names, key=lambda name: (ORDER.index(name) if name in ORDER else len(ORDER), name)))


@cache
def get(name: str) -> Sheet:
    """Return a sheet of the library.

    Raises
    ------
    InputError
        When there is none of that id.
    """
    if name not in ids():
        raise unknown("sheet", name, ids(), "sheet")
    return check((files(__name__) / f"{name}.md").read_text("utf-8"), name)
