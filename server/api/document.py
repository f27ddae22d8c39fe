"""The OpenAPI document of the application: also for generated clients, and with the messages of the stream in it."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic import TypeAdapter

from scenarios.json_schema.components import COMPONENT
from scenarios.json_schema.components import components as documents
from scenarios.json_schema.definitions import OURS, walked
from server.api.examples import EXAMPLES
from server.api.paging import LINK
from server.api.tags import TAGS
from server.classroom.access import Need, need_of
from server.errors import ErrorReply
from server.progress import WorkProgress
from server.stream.wire import ClientMessage, ServerMessage

REF = "#/components/schemas/{model}"
HERE = {
    "url": "http://{host}:{port}",
    "description": "Where `combbench serve` listens",
    "variables": {"host": {"default": "127.0.0.1"}, "port": {"default": "8000"}},
}
BEARER = {
    "type": "http",
    "scheme": "bearer",
    "description": "The access token that the server prints at its start; for a student, the session of a class",
}
PARAMETERS = {
    "bench_id": "Id of a bench",
    "benchmark_id": "Id of a benchmark",
    "class_id": "Id of a class",
    "columns": "Number of columns; each has the smallest and the largest value of its ticks",
    "descending": "Whether the largest values come first",
    "drive_v": "Voltage that is held, V",
    "end_tick": "The tick after the last; left out: up to the newest tick",
    "family": "Family of blocks, such as control or faults; left out: all families",
    "format": "Format of the answer",
    "game_id": "Id of a game",
    "kind": "Kind of the listed links; left out: all kinds",
    "lecture_id": "Id of a lecture",
    "link_id": "Id of a link",
    "member_id": "Id of a student",
    "name": "Id of a diagnoser or a read-out; on a twin: <twin>:<id>",
    "number": "Number of the cue, from 1",
    "device_id": "Id of a measured device",
    "record_id": "Id of a record of a device",
    "recording_id": "Id of a recording",
    "run_id": "Id of a run",
    "scenario_id": "Id of a scenario of the library",
    "set_id": "Id of a parameter set",
    "sheet_id": "Id of a lab sheet",
    "signal": "Name of a signal",
    "snapshot_id": "Id of a snapshot",
    "start_tick": "The first tick; left out: the oldest tick",
    "step_id": "Id of a step of the sheet",
    "sweep_id": "Id of a campaign",
    "threshold_id": "Id of a search for a threshold",
    "vote_id": "Id of a vote",
    "watcher_id": "Id of a link to watch",
}
"""The meaning of parameters whose route does not give it."""
REFUSALS = {"4XX": ("Refused", "The request is refused"), "5XX": ("Failed", "The server cannot answer")}
"""Answers of every operation beside its own: the name and the description of each, by their status."""
TEXT, BINARY = {"type": "string"}, {"type": "string", "format": "binary"}


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
        license_info=app.license_info,
        tags=[{"name": name, "description": meaning} for name, meaning in TAGS.items()],
        routes=app.routes,
        servers=app.servers or [HERE],
    )
    components = schema.setdefault("components", {}).setdefault("schemas", {})
    for name, kind, mode in (
        ("ClientMessage", ClientMessage, "validation"),
        ("ServerMessage", ServerMessage, "serialization"),
        ("ErrorReply", ErrorReply, "validation"),
        ("WorkProgress", WorkProgress, "serialization"),
    ):
        described = TypeAdapter(kind).json_schema(mode=mode, ref_template=REF)  # type: ignore[arg-type]
        for inner, definition in described.pop("$defs", {}).items():
            components.setdefault(inner, definition)
        components[name] = {"title": name, **described}
    components |= documents()
    shape = {"application/json": {"schema": {"$ref": REF.format(model="ErrorReply")}}}
    schema["components"]["responses"] = {
        name: {"description": meaning, "content": shape} for name, meaning in REFUSALS.values()
    }
    schema["components"]["securitySchemes"] = {"token": BEARER}
    for path, operations in schema["paths"].items():
        for method, operation in operations.items():
            _complete(operation, is_open=need_of(method.upper(), path)[0] is Need.NOTHING)
    components.pop("HTTPValidationError", None)
    components.pop("ValidationError", None)
    schema["components"]["schemas"] = {name: _standard(one) for name, one in components.items()}
    whole: dict[str, Any] = walked(schema, _described)
    return whole


def _described(table: dict[str, Any]) -> dict[str, Any]:
    """Refer to the component that describes a table, in the place of its name."""
    component = table.pop(COMPONENT, None)
    return table if component is None else {"$ref": REF.format(model=component), **table}


def _complete(operation: dict[str, Any], is_open: bool) -> None:
    """Add callers, meanings of parameters, examples of bodies, the next page, the type of files, and all failures."""
    operation["security"] = [] if is_open else [{"token": []}]
    for parameter in operation.get("parameters", []):
        parameter.setdefault("description", PARAMETERS.get(parameter["name"], ""))
    for name, content in operation.get("requestBody", {}).get("content", {}).items():
        if name == "application/json":
            values = EXAMPLES.get(operation["operationId"], ())
            content["examples"] = {f"example-{number}": {"value": value} for number, value in enumerate(values, 1)}
    responses = operation["responses"]
    if {"after", "limit"} <= {parameter["name"] for parameter in operation.get("parameters", [])}:
        responses["200"]["headers"] = {"Link": LINK}
    responses.pop("422", None)
    for response in responses.values():
        for media, content in response.get("content", {}).items():
            content.setdefault("schema", TEXT if media.startswith("text/") else BINARY)
    responses |= {status: {"$ref": f"#/components/responses/{name}"} for status, (name, _) in REFUSALS.items()}


def _standard(schema: Any) -> Any:
    """Return a schema with the keywords of our own by names that OpenAPI permits."""
    if not isinstance(schema, dict):
        return schema
    found = {f"x-{key}" if key in OURS else key: value for key, value in schema.items()}
    if "properties" in found:
        found["properties"] = {name: _standard(one) for name, one in found["properties"].items()}
    return found
