"""The OpenAPI document: complete, in the one error shape, with the stream in it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from jsonschema_rs import Draft202012Validator
from pydantic import TypeAdapter

from core.nesting import read_toml
from scenarios.campaign.sweep import Sweep
from scenarios.sheets.read import read_sheet
from server.api.document import BINARY, REF, TEXT
from server.api.examples import EXAMPLES
from server.api.tags import TAGS
from server.app import create_app
from server.settings import Settings
from server.stream.wire import CLIENT_MESSAGE, ClientMessage, ServerMessage


@pytest.fixture(scope="module")
def document(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    found: dict[str, Any] = create_app(Settings(data=tmp_path_factory.mktemp("data"))).openapi()
    return found


def references(node: Any) -> set[str]:
    if isinstance(node, dict):
        own = {node["$ref"]} if isinstance(node.get("$ref"), str) else set()
        return own.union(*(references(value) for value in node.values())) if node else own
    if isinstance(node, list):
        return set().union(*(references(value) for value in node)) if node else set()
    return set()


def operations(document: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    """Return each operation with its method and path."""
    return [(f"{method} {path}", one) for path, each in document["paths"].items() for method, one in each.items()]


def test_the_paths_of_the_contract_are_there(document: dict[str, Any]) -> None:
    wanted = {
        "/catalog", "/devices", "/scenarios", "/benches", "/benches/{bench_id}", "/benches/{bench_id}/commands",
        "/benches/{bench_id}/events", "/benches/{bench_id}/trace", "/benches/{bench_id}/snapshots",
        "/benches/{bench_id}/recordings", "/runs", "/runs/{run_id}", "/runs/{run_id}/trace",
    }  # fmt: skip
    assert {f"/api/v1{path}" for path in wanted} | {"/health/live", "/health/ready", "/metrics"} <= set(
        document["paths"]
    )


def test_each_schema_is_titled_by_its_name_alone(document: dict[str, Any]) -> None:
    schemas = document["components"]["schemas"]
    assert [name for name, schema in schemas.items() if schema.get("title") != name] == []


def test_each_operation_has_a_short_name_of_its_own(document: dict[str, Any]) -> None:
    names = [operation["operationId"] for _, operation in operations(document)]
    assert len(set(names)) == len(names)
    assert [name for name in names if len(name) > 32 or not re.fullmatch(r"[a-z]+(_[a-z]+)*", name)] == []


def test_each_parameter_says_its_meaning(document: dict[str, Any]) -> None:
    for where, operation in operations(document):
        for parameter in operation.get("parameters", []):
            assert len(parameter.get("description", "")) > 5, (where, parameter["name"])


def test_each_body_has_two_examples_that_it_takes(document: dict[str, Any]) -> None:
    bodies = {operation["operationId"]: operation["requestBody"] for _, operation in operations(document)
              if "application/json" in operation.get("requestBody", {}).get("content", {})}  # fmt: skip
    assert EXAMPLES.keys() == bodies.keys()
    for name, body in bodies.items():
        content = body["content"]["application/json"]
        schema = {**content["schema"], "components": document["components"]}
        examples = [example["value"] for example in content["examples"].values()]
        assert len(examples) == 2 and examples[0] != examples[1], name
        for example in examples:
            Draft202012Validator(schema).validate(example)


def test_examples_of_plain_questions_are_answered(live: Any, document: dict[str, Any]) -> None:
    asked = [(where.split()[1], operation["operationId"]) for where, operation in operations(document)
             if re.match("post /api/v1/(devices|theory|scenarios|units|benches$)", where)]  # fmt: skip
    for path, name in asked:
        for example in EXAMPLES.get(name, ()) if "{" not in path else ():
            answer = live.http.post(path, json=example)
            assert answer.is_success, (name, answer.text)
            assert answer.json().get("error") is None, (name, answer.text)


def test_examples_of_campaigns_and_sheets_can_be_read() -> None:
    for example in EXAMPLES["start_sweep"]:
        assert len(Sweep(read_toml(text, "sweep") if isinstance(text := example["sweep"], str) else text)) >= 2
    for example in EXAMPLES["open_sheet"]:
        assert read_sheet(example["text"], "example").head.title


def test_the_stream_and_the_doors_mean_the_same_by_each_name(document: dict[str, Any]) -> None:
    schemas = document["components"]["schemas"]
    for kind, mode in ((ClientMessage, "validation"), (ServerMessage, "serialization")):
        inner = TypeAdapter(kind).json_schema(mode=mode, ref_template=REF)["$defs"]  # type: ignore[arg-type]
        for name, schema in inner.items():
            assert schemas[name].get("properties", {}).keys() == schema.get("properties", {}).keys(), name
            assert schemas[name].get("description", "") == schema.get("description", ""), name


def test_clients_learn_where_the_service_is_and_how_to_come_in(document: dict[str, Any], tmp_path: Path) -> None:
    assert [server["url"] for server in document["servers"]] == ["http://{host}:{port}"]
    usual = {name: one["default"] for name, one in document["servers"][0]["variables"].items()}
    assert usual == {"host": Settings.model_fields["host"].default, "port": str(Settings.model_fields["port"].default)}
    public = create_app(Settings(data=tmp_path, public_origin="https://lab.example/bench"))
    assert [server["url"] for server in public.servers] == ["https://lab.example/bench"]
    scheme = document["components"]["securitySchemes"]["token"]
    assert (scheme["type"], scheme["scheme"]) == ("http", "bearer")
    opened = {where for where, operation in operations(document) if operation["security"] == []}
    schemas = {"get /api/v1/schemas", "get /api/v1/schemas/{name}"}
    assert opened == {"get /health/live", "get /health/ready", "post /api/v1/classes/{class_id}/join"} | schemas
    assert all(operation["security"] in ([], [{"token": []}]) for _, operation in operations(document))


def test_no_reference_leads_nowhere_and_each_part_is_used(document: dict[str, Any]) -> None:
    parts = {
        f"#/components/{kind}/{name}" for kind in ("schemas", "responses") for name in document["components"][kind]
    }
    stream = {REF.format(model="ClientMessage"), REF.format(model="ServerMessage")}
    assert references(document) | stream == parts


def test_each_group_of_operations_is_described(document: dict[str, Any]) -> None:
    assert {tag for _, operation in operations(document) for tag in operation["tags"]} == TAGS.keys()
    assert document["tags"] == [{"name": name, "description": about} for name, about in TAGS.items()]


def test_files_are_text_or_bytes_and_everything_else_is_typed(document: dict[str, Any]) -> None:
    for where, operation in operations(document):
        for status, answer in operation["responses"].items():
            for media, content in answer.get("content", {}).items():
                schema = content["schema"]
                if media == "application/json":
                    assert references(schema), (where, status)
                elif media == "application/schema+json":
                    assert schema == {"type": "object"}, where
                elif media == "text/event-stream":
                    assert "type" not in schema, where  # readers take it for the schema of each event
                    assert references(content["x-item-schema"]), where
                else:
                    assert schema == (TEXT if media.startswith("text/") else BINARY), (where, media)


def test_every_operation_has_a_typed_answer_a_summary_and_the_error_shape(document: dict[str, Any]) -> None:
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            where = f"{method} {path}"
            assert operation.get("summary"), where
            assert operation.get("description"), where
            assert "422" not in operation["responses"], where
            for status, name in (("4XX", "Refused"), ("5XX", "Failed")):
                assert operation["responses"][status] == {"$ref": f"#/components/responses/{name}"}, where
                shape = document["components"]["responses"][name]["content"]["application/json"]["schema"]
                assert shape == {"$ref": "#/components/schemas/ErrorReply"}, where
            good = [code for code in operation["responses"] if code.startswith("2")]
            assert good, where
            if good[0] not in ("204",):
                assert operation["responses"][good[0]].get("content"), where


def test_the_messages_of_the_stream_are_described(document: dict[str, Any]) -> None:
    schemas = document["components"]["schemas"]
    client = {ref.rsplit("/", 1)[1] for ref in references(schemas["ClientMessage"])}
    server = {ref.rsplit("/", 1)[1] for ref in references(schemas["ServerMessage"])}
    assert {"Subscribe", "Rearm", "Unsubscribe", "Ack", "Resume", "CommandMessage"} <= client
    assert {"Hello", "Status", "EventsMessage", "Reply", "ErrorMessage", "Notice"} <= server
    assert {"Inject", "HealFaults", "SetValues", "Switch", "TimeScale", "Step"} <= set(schemas)
    assert schemas["ErrorBody"]["required"] == ["code", "message"]
    assert TypeAdapter(ServerMessage) and CLIENT_MESSAGE


def test_the_service_answers_with_this_document(live: Any, document: dict[str, Any]) -> None:
    assert live.http.get("/api/v1/openapi.json").json() == document


def test_a_method_that_is_not_allowed_hears_of_all_that_are(live: Any) -> None:
    for path, operations in live.http.get("/api/v1/openapi.json").json()["paths"].items():
        known = {method.upper() for method in operations} & {"GET", "POST", "PUT", "PATCH", "DELETE"}
        answer = live.http.request("TRACE", path.replace("{", "").replace("}", ""))
        assert answer.status_code == 405, (path, answer.status_code)
        assert known <= set(answer.headers["Allow"].split(", ")), path
        assert set(answer.json()) == {"error"}
