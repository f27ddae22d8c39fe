"""The library: every experiment of the dissertation, one TOML file each, with its claim and verdict."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from core.errors import unknown
from scenarios.schema import Scenario


@cache
def library() -> tuple[Scenario, ...]:
    """Return every scenario of the library in the order of the text: its chapters, then its appendices."""
    entries = [entry for entry in files(__name__).iterdir() if entry.name.endswith(".toml")]
    found = [Scenario.load(entry.read_text("utf-8")) for entry in entries]
    return tuple(
        sorted(
            found,
            key=lambda scenario: (scenario.id.startswith("app"), not scenario.id.startswith("first"), scenario.id),
        )
    )


def get(name: str) -> Scenario:
    """Return one scenario of the library.

    Raises
    ------
    InputError
        When there is none of that id.
    """
    known = {scenario.id: scenario for scenario in library()}
    if name not in known:
        raise unknown("scenario", name, known, "scenario")
    return known[name]
