"""The library: the experiments of the dissertation and some more, one TOML file each, with claim and verdict."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from core.errors import unknown
from scenarios.schema import Scenario


@cache
def ids() -> tuple[str, ...]:
    """Return the id of every scenario in the order of the text: chapters, gyroscopes, appendices. It names the file."""
    names = [entry.name for entry in files(__name__).iterdir() if entry.name.endswith(".toml")]
    ids = [name.removesuffix(".toml") for name in names]
    return tuple(sorted(ids, key=lambda name: (name.startswith("app"), not name.startswith("first"), name)))


@cache
def library() -> tuple[Scenario, ...]:
    """Return every scenario of the library in the order of the text: its chapters, then its appendices."""
    return tuple(_read(name) for name in ids())


def is_demo(name: str) -> bool:
    """Return whether a scenario is made for first visits and lectures; its id says so."""
    return name.endswith("first-look") or name.startswith("demo-")


def get(name: str) -> Scenario:
    """Return one scenario of the library; no other is read.

    Raises
    ------
    InputError
        When there is none of that id.
    """
    if name not in ids():
        raise unknown("scenario", name, ids(), "scenario")
    return _read(name)


@cache
def _read(name: str) -> Scenario:
    return Scenario.load((files(__name__) / f"{name}.toml").read_text("utf-8"))
