"""Tuning: the parameters of a bench that may change while it runs, and how two sets of them differ."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from core.board.document import CHOSEN
from core.board.spec import Section, Spec
from core.cards import is_live

SINGLE = ("environment", "plant", "reference", "model", "drive", "board", "guard")
EXCHANGED = ("reference",)
"""Of these, and of generators, the kind may change while a bench runs."""


def sections(spec: Spec) -> dict[str, Section]:
    """Return the sections of a bench by their paths; the controller and the sensor in use are under their own names."""
    found: dict[str, Section] = {} if spec.axes else {"reference": spec.reference, "model": spec.model}
    found |= {key: getattr(spec, key) for key in SINGLE if key not in ("reference", "model")}
    for key in ("controllers", "sensors", *CHOSEN):
        found |= {f"{key}.{name}": section for name, section in getattr(spec, key).items()}
    return found | spec.generators | spec.supervisors


def tuned(spec: Spec) -> dict[str, Any]:
    """Return every value that may change while the bench runs, by its path."""
    values: dict[str, Any] = {}
    for path, section in sections(spec).items():
        if path in EXCHANGED or path in spec.generators:
            values[f"{path}.kind"] = section.block.name
        live = {name for name, info in type(section.params).model_fields.items() if is_live(info)}
        written = section.params.model_dump(mode="json", include=live)
        values |= {f"{path}.{name}": value for name, value in written.items()}
    return values


def difference(spec: Spec, wanted: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values to set on a bench, so that it takes the values of a set where both have them.

    Where the set has another block, or no value for a parameter that the bench gives, the whole section is set.
    """
    now = tuned(spec)
    changed = {path: value for path, value in wanted.items() if path in now and now[path] != value}
    found: dict[str, Any] = {}
    for path, value in changed.items():
        head, _, leaf = path.rpartition(".")
        if leaf == "kind" or value is None or head in found:
            fixed = {} if f"{head}.kind" in changed else _fixed(spec, head)
            own = {name.rpartition(".")[2]: one for name, one in wanted.items() if name.rpartition(".")[0] == head}
            found[head] = fixed | {name: one for name, one in own.items() if one is not None}
        else:
            found[path] = value
    return {path: value for path, value in found.items() if path.rpartition(".")[0] not in found}


def absent(spec: Spec, wanted: Mapping[str, Any]) -> list[str]:
    """Return the paths of a set that a bench does not have."""
    now = tuned(spec)

    def exchanged(path: str) -> bool:
        kind = f"{path.rpartition('.')[0]}.kind"
        return kind in now and kind in wanted and now[kind] != wanted[kind]

    return [path for path in wanted if path not in now and not exchanged(path)]


def _fixed(spec: Spec, path: str) -> dict[str, Any]:
    """Return the values of a section in the document of a bench that cannot change while it runs."""
    table: Any = spec.document
    for name in path.split("."):
        table = table.get(name, {}) if isinstance(table, dict) else {}
    live = {name for name, info in type(sections(spec)[path].params).model_fields.items() if is_live(info)}
    return {name: value for name, value in table.items() if name not in live}
