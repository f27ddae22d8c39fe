"""Definitions of JSON Schema from the models that read documents: titles, meanings with units, ranges."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from pydantic import BaseModel, TypeAdapter

from core.format import unit_text

Schema = dict[str, Any]
REF = "#/$defs/{model}"
OURS = ("unit", "equation", "live")
"""Keywords of parameters that JSON Schema does not know."""


class Definitions:
    """The definitions of a document, each once, by name."""

    def __init__(self) -> None:
        self.found: dict[str, Schema] = {}
        self._fixed: set[str] = set()

    def fix(self, name: str, schema: Schema) -> Schema:
        """Add a definition in place of the definitions that later models have of this name."""
        self._fixed.add(name)
        self.found[name] = {"title": name, **schema}
        return ref(name)

    def add(self, name: str, schema: Schema) -> Schema:
        """Add a definition; return the reference to it.

        Raises
        ------
        ValueError
            When the name has another definition.
        """
        titled = {"title": name, **schema}
        if self.found.setdefault(name, titled) != titled and name not in self._fixed:
            raise ValueError(f"two definitions of {name}")
        return ref(name)

    def model(self, kind: Any) -> Schema:
        """Return the schema of a model or a union of models; its parts become definitions."""
        is_model = isinstance(kind, type) and issubclass(kind, BaseModel)
        make = kind.model_json_schema if is_model else TypeAdapter(kind).json_schema
        schema: Schema = make(ref_template=REF)
        parts = {name: plain(part) for name, part in schema.pop("$defs", {}).items()}
        free = {name: self._free(name, part) for name, part in parts.items()}
        names = {ref(name)["$ref"]: ref(free[name])["$ref"] for name in parts}
        for name, part in parts.items():
            self.add(free[name], _renamed(part, names))
        return _renamed(plain(schema), names)

    def _free(self, name: str, schema: Schema) -> str:
        """Return a name for the part of a model; classes of installed packages may have a name that is taken."""
        titled = {"title": name, **schema}
        is_free = name in self._fixed or self.found.get(name, titled) == titled
        return name if is_free else self._free(f"{name}2", schema)


def ref(name: str) -> Schema:
    """Return a reference to a definition."""
    return {"$ref": REF.format(model=name)}


def _renamed(schema: Schema, names: dict[str, str]) -> Schema:
    """Return a schema with other references."""
    made: Schema = walked(schema, lambda one: {**one, "$ref": names[one["$ref"]]} if one.get("$ref") in names else one)
    return made


def plain(schema: Schema) -> Schema:
    """Return a schema of pydantic as editors want it: the unit in the meaning, no title made from a name."""
    properties = {name: _field(field) for name, field in schema.get("properties", {}).items()}
    rest = {key: value for key, value in schema.items() if key not in ("properties", "title", "discriminator")}
    if "description" in rest:
        rest["description"] = summary(rest["description"])
    return {**_without_discriminators(rest), **({"properties": properties} if properties else {})}


def summary(text: str) -> str:
    """Return the first paragraph of a docstring as editors show it: in one line, with formulas in backquotes."""
    return " ".join(text.strip().split("\n\n")[0].split()).replace(":math:`", "`")


def _field(field: Schema) -> Schema:
    """Return the schema of a field."""
    unit = unit_text(str(field.get("unit", "")))
    if "patternProperties" in field:  # a mapping whose keys have a pattern has no other keys
        field = {**field, "additionalProperties": False}
    kept = {
        key: value
        for key, value in field.items()
        if key not in (*OURS, "title") and not (key == "default" and value is None)
    }
    if unit:
        kept["description"] = f"{kept['description']}, {unit}" if kept.get("description") else unit
    shown: Schema = _without_discriminators(kept)
    return shown


def _without_discriminators(node: Any) -> Any:
    """Return a schema without the keyword ``discriminator``, which belongs to OpenAPI."""
    return walked(node, lambda one: {key: value for key, value in one.items() if key != "discriminator"})


def walked(node: Any, change: Callable[[Schema], Any]) -> Any:
    """Return a copy of a schema in which every table is changed, the innermost first."""
    if isinstance(node, dict):
        return change({key: walked(value, change) for key, value in node.items()})
    return [walked(value, change) for value in node] if isinstance(node, list) else node
