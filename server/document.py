"""The OpenAPI document of the application, with the messages of the stream in it: one generator types both."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic import TypeAdapter

from server.errors import ErrorReply
from server.stream.wire import ClientMessage, ServerMessage

REF = "#/components/schemas/{model}"


def install(app: FastAPI) -> None:
    """Replace the document of ``app`` by one with the messages of the stream."""

    def document() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = build(app)
        return app.openapi_schema

    app.openapi = document  # type: ignore[method-assign]


def build(app: FastAPI) -> dict[str, Any]:
    """Build the document."""
    schema = get_openapi(
        title=app.title,
        version=app.version,
        description=app.description,
        routes=app.routes,
        servers=app.servers or None,
    )
    components = schema.setdefault("components", {}).setdefault("schemas", {})
    for name, kind, mode in (
        ("ClientMessage", ClientMessage, "validation"),
        ("ServerMessage", ServerMessage, "serialization"),
    ):
        described = TypeAdapter(kind).json_schema(mode=mode, ref_template=REF)  # type: ignore[arg-type]
        for inner, definition in described.pop("$defs", {}).items():
            components.setdefault(inner, definition)
        components[name] = described
    components["ErrorReply"] = TypeAdapter(ErrorReply).json_schema(ref_template=REF)
    for inner, definition in components["ErrorReply"].pop("$defs", {}).items():
        components.setdefault(inner, definition)
    _use_error_shape(schema)
    components.pop("HTTPValidationError", None)
    components.pop("ValidationError", None)
    return schema


def _use_error_shape(schema: dict[str, Any]) -> None:
    """Describe every failure by the one shape of all errors."""
    shape = {"application/json": {"schema": {"$ref": REF.format(model="ErrorReply")}}}
    for operations in schema["paths"].values():
        for operation in operations.values():
            operation["responses"].pop("422", None)
            operation["responses"]["default"] = {"description": "Refused or failed", "content": shape}
