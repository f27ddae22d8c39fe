"""Pages of the Python names: those of ``combbench``, and those that a user unit may import."""

from __future__ import annotations

import importlib
import inspect
import typing
from collections.abc import Iterator
from typing import Any

import combbench
from core.own.offered import OFFERED
from manual.markdown import code, page, shown, table

READERS = "For people who write Python."
UNITS = "For people who write a unit of their own."


def pages() -> dict[str, str]:
    """Return the pages by their address."""
    about = "`import combbench as cb`. [The bench from Python](../tutorials/python.md) shows these names at work."
    parts = [part for name in combbench.__all__ for part in _public(name)]
    offered = (
        "A unit imports these names and no others; [Write a unit of your own](../tutorials/own-units.md) explains its "
        "notation. Of `math` it may import `sqrt`, `copysign`, `isfinite`, `pi` and `inf`."
    )
    return {
        "reference/python": page("Python", READERS, [about, *parts]),
        "reference/unit-names": page("Names for units", UNITS, [offered, *_offered()]),
    }


def _public(name: str) -> Iterator[str]:
    """Write a name of the package; Sphinx takes its signature and its docstring."""
    value = getattr(combbench, name)
    yield f"## {shown(name)}"
    if inspect.isclass(value):
        lines = [f".. autoclass:: combbench.{name}", "   :members:"]
        lines += ["   :show-inheritance:"] if value.__bases__ != (object,) else []
    elif callable(value):
        lines = [f".. autofunction:: combbench.{name}"]
    else:
        lines = [f".. py:data:: combbench.{name}", "   :type: str", "", "   The version of the package."]
    yield "\n".join(["```{eval-rst}", *lines, "```"])


def _offered() -> Iterator[str]:
    """Write a table for each module."""
    for module, names in OFFERED.items():
        found = importlib.import_module(module)
        yield f"## {module.replace('__', chr(92) + '_' + chr(92) + '_')}"
        yield table(("name", "meaning"), [(code(name), _meaning(getattr(found, name))) for name in names])


def _meaning(value: Any) -> str:
    """Return the first sentence of a docstring, or a constant."""
    if isinstance(value, float | int | str):
        return code(value)
    if inspect.isclass(value) or callable(value) or inspect.ismodule(value):
        said = inspect.getdoc(value) or ""
        return shown(" ".join(said.split("\n\n")[0].split()))
    return "" if value is typing.Any else shown(type(value).__name__)
