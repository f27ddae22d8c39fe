"""JSON Schemas by address: without a token, under the address by which the caller came."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import httpx
from jsonschema_rs import Draft202012Validator

from scenarios.json_schema.documents import json_schema
from tests.server.conftest import serving


def test_editors_fetch_the_schemas_without_a_token(live: Any) -> None:
    cards = httpx.get(f"{live.address}/api/v1/schemas").json()["schemas"]
    assert [card["name"] for card in cards] == ["scenario", "campaign", "sheet", "lecture"]
    for card in cards:
        assert card["url"] == f"{live.address}/api/v1/schemas/{card['name']}"
        answer = httpx.get(card["url"])
        assert answer.headers["Content-Type"] == "application/schema+json"
        assert f'filename="{card["name"]}.schema.json"' in answer.headers["Content-Disposition"]
        found = answer.json()
        assert (found["$id"], found["title"]) == (card["url"], card["title"])
        assert {**found, "$id": ""} == {**json_schema(card["name"]), "$id": ""}


def test_an_unknown_schema_is_refused_with_advice(live: Any) -> None:
    refused = live.http.get("/api/v1/schemas/scenaro")
    assert (refused.status_code, refused.json()["error"]["hint"]) == (404, "did you mean scenario?")


def test_behind_a_proxy_the_address_is_the_public_one(tmp_path: Path) -> None:
    with serving(tmp_path, public_origin="https://lab.example/bench") as live:
        found = httpx.get(f"{live.address}/api/v1/schemas/sheet", headers={"Host": "lab.example"}).json()
    assert found["$id"] == "https://lab.example/bench/api/v1/schemas/sheet"


def test_a_saved_scenario_is_valid_and_the_same_from_any_host(live: Any) -> None:
    bench = live.bench("first-look", paused=True)
    path = f"{live.address}/api/v1/benches/{bench['id']}/scenario"
    token = {"Authorization": live.http.headers["Authorization"]}
    texts = {httpx.get(path.replace("127.0.0.1", host), headers=token).text for host in ("127.0.0.1", "localhost")}
    (text,) = texts
    assert text.startswith("#:schema ./scenario.schema.json\n")
    checked = live.http.post("/api/v1/scenarios/check", json={"scenario": text}).json()
    Draft202012Validator(json_schema("scenario")).validate(checked["document"])
    assert checked["toml"].startswith("#:schema ./scenario.schema.json\n")


def test_a_json_document_may_name_its_schema(live: Any) -> None:
    document = {"$schema": "./scenario.schema.json", "samples": 100}
    assert live.http.post("/api/v1/scenarios/check", json={"scenario": document}).json()["document"] == {"samples": 100}
