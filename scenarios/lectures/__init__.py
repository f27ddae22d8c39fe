"""Lectures of ten minutes, one TOML file each; every figure their notes name is an expectation."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from core.errors import unknown
from scenarios.lecture import Lecture


@cache
def lecture_ids() -> tuple[str, ...]:
    """Return the id of every lecture, in the order of the chapters."""
    names = (entry.name for entry in files(__name__).iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml")))


@cache
def lecture(name: str) -> Lecture:
    """Return a lecture.

    Raises
    ------
    InputError
        When there is none of that id, or its file is wrong: naming the cue and the field.
    """
    if name not in lecture_ids():
        raise unknown("lecture", name, lecture_ids(), "lecture")
    return Lecture.load(name, (files(__name__) / f"{name}.toml").read_text("utf-8"))
