"""The OpenAPI document: complete, in the one error shape, with the stream in it."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import TypeAdapter

from server.app import create_app
from server.settings import Settings
from server.stream.wire import CLIENT_MESSAGE, ServerMessage


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


def test_the_paths_of_the_contract_are_there(document: dict[str, Any]) -> None:
    wanted = {
        "/catalog", "/devices", "/scenarios", "/benches", "/benches/{bench_id}", "/benches/{bench_id}/commands",
        "/benches/{bench_id}/events", "/benches/{bench_id}/trace", "/benches/{bench_id}/snapshots",
        "/benches/{bench_id}/recordings", "/runs", "/runs/{run_id}", "/runs/{run_id}/trace",
    }  # fmt: skip
    assert {f"/api/v1{path}" for path in wanted} | {"/health/live", "/health/ready", "/metrics"} <= set(
        document["paths"]
    )


def test_no_reference_leads_nowhere(document: dict[str, Any]) -> None:
    known = {f"#/components/schemas/{name}" for name in document["components"]["schemas"]}
    assert references(document) <= known


def test_every_operation_has_a_typed_answer_a_summary_and_the_error_shape(document: dict[str, Any]) -> None:
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            where = f"{method} {path}"
            assert operation.get("summary"), where
            assert operation.get("description"), where
            assert "422" not in operation["responses"], where
            shape = operation["responses"]["default"]["content"]["application/json"]["schema"]
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
    assert {"Hello", "Status", "Events", "Reply", "ErrorMessage", "Notice"} <= server
    assert {"Inject", "Heal", "Set", "Switch", "TimeScale", "Step"} <= set(schemas)
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
