"""Pages of the REST interface, from the OpenAPI document: operations by their tags, and the schemas they use first."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from manual.markdown import code, menu, page, shown, table
from manual.plan import ROOT

DOCUMENT = ROOT / "web" / "openapi.json"
READERS = "For people whose programs call the server."
USUAL = "Successful Response"
"""A description that says no more than its status."""
METHODS = ("get", "put", "post", "patch", "delete")
Json = dict[str, Any]


def pages() -> dict[str, str]:
    """Return the pages by their address: a list of the tags, and one page for each."""
    document = json.loads(DOCUMENT.read_text())
    schemas, written = document["components"]["schemas"], set[str]()
    found: dict[str, str] = {}
    rows = []
    for tag in document["tags"]:
        operations = [
            (method, path, door[method])
            for path, door in document["paths"].items()
            for method in METHODS
            if method in door and door[method]["tags"] == [tag["name"]]
        ]
        used = [name for name in _reached(operations, schemas) if name not in written]
        written |= {*used}
        parts = [f"{shown(tag['description'])}."]
        parts += [part for operation in operations for part in _operation(*operation)]
        parts += ["## Schemas"] if used else []
        parts += [part for name in sorted(used) for part in _schema(name, schemas[name])]
        name = tag["name"].replace(" ", "-")
        title = tag["name"][:1].upper() + tag["name"][1:]
        found[f"reference/rest/{name}"] = page(title, READERS, parts)
        rows.append((f"[{title}]({name}.md)", str(len(operations)), f"{shown(tag['description'])}."))
    about = (
        "Generated from the OpenAPI document, which is `web/openapi.json` and `/api/v1/openapi.json` of a server. "
        "[The tutorial](../../tutorials/rest.md) begins with a token; "
        "[generated clients](../../how-to/generated-clients.md) need no code of yours. A refusal has the shape of "
    )
    refused = _schema_names(document["components"]["responses"])
    about += " or ".join(map(_link, refused)) + "."
    rest = sorted(schemas.keys() - written)
    parts = [about, table(("group", "operations", "content"), rows), menu(map(_file, found))]
    parts += (
        ["## Refusals, and messages of the stream", *(part for name in rest for part in _schema(name, schemas[name]))]
        if rest
        else []
    )
    return {"reference/rest/index": page("REST", READERS, parts), **found}


def _file(address: str) -> str:
    return address.rpartition("/")[2]


def _operation(method: str, path: str, operation: Json) -> Iterator[str]:
    """Write an operation: parameters, body, answers."""
    yield f"(operation-{operation['operationId']})=\n## {method.upper()} {shown(path)}"
    yield f"{code(operation['operationId'])} · {shown(' '.join(operation.get('description', '').split()))}"
    rows = [
        (code(one["name"]), one["in"], kind(one["schema"]), shown(one.get("description", "")))
        for one in operation.get("parameters", ())
    ]
    yield table(("parameter", "in", "type", "meaning"), rows)
    answers = [("body", media, kind(content.get("schema", {})), "") for media, content in _content(operation)]
    answers += [
        (code(status), media, kind(content.get("schema", {})), shown(answer["description"].replace(USUAL, "")))
        for status, answer in operation["responses"].items()
        for media, content in (answer.get("content") or {"": {}}).items()
        if "$ref" not in answer
    ]
    yield table(("body or status", "media type", "schema", "meaning"), answers)


def _content(operation: Json) -> Any:
    return operation.get("requestBody", {}).get("content", {}).items()


def _schema(name: str, schema: Json) -> Iterator[str]:
    """Write a schema: its fields, or its kind."""
    yield f"(schema-{name.lower()})=\n### {shown(name)}"
    yield shown(" ".join(schema.get("description", "").split()))
    required = schema.get("required", ())
    rows = [
        (code(field), kind(one), "yes" if field in required else "", shown(_meaning(one)))
        for field, one in schema.get("properties", {}).items()
    ]
    yield table(("field", "type", "required", "meaning"), rows) or f"{kind(schema)}."


def _link(name: str) -> str:
    return f"[{name}](#schema-{name.lower()})"  # anchors are in small letters


def _meaning(schema: Json) -> str:
    unit = f" [{schema['unit']}]" if schema.get("unit") else ""
    return " ".join(f"{schema.get('description', '')}{unit}".split())


def kind(schema: Json) -> str:
    """Return the kind of a value in words, with links to schemas."""
    if "$ref" in schema:
        return _link(schema["$ref"].rpartition("/")[2])
    for one in ("anyOf", "oneOf", "allOf"):
        if one in schema:
            return " or ".join(dict.fromkeys(map(kind, schema[one])))
    if "const" in schema:
        return code(json.dumps(schema["const"]))
    if "enum" in schema:
        return ", ".join(code(json.dumps(value)) for value in schema["enum"])
    if schema.get("type") == "array":
        return f"list of {kind(schema.get('items', {}))}"
    values = schema.get("additionalProperties")
    if isinstance(values, dict) and values and "properties" not in schema:
        return f"object of {kind(values)}"
    named = schema.get("type", "any value")
    return " or ".join(named) if isinstance(named, list) else str(named)


def _schema_names(value: Any) -> list[str]:
    """Return the schemas that a part of the document names, in its order."""
    if isinstance(value, dict):
        named = [value["$ref"].rpartition("/")[2]] if "/schemas/" in str(value.get("$ref")) else []
        return [*dict.fromkeys([*named, *(name for one in value.values() for name in _schema_names(one))])]
    if isinstance(value, list):
        return [*dict.fromkeys(name for one in value for name in _schema_names(one))]
    return []


def _all_from(names: list[str], schemas: Json) -> set[str]:
    """Return schemas with those that they name, and so on."""
    found, left = set[str](), [*names]
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            left += _schema_names(schemas[name])
    return found


def _reached(operations: list[tuple[str, str, Json]], schemas: Json) -> set[str]:
    return _all_from(_schema_names([operation for _, _, operation in operations]), schemas)
