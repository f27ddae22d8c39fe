"""Documents nested beyond reason, or with half a letter: one clear line each, and the bench runs on."""

from __future__ import annotations

import json
from typing import Any

import pytest

from tests.server.test_bad_input import check, failing, runs_on

JSON = {"Content-Type": "application/json"}


def nested(levels: int, leaf: Any = 1) -> Any:
    """Tables in one another."""
    for _ in range(levels):
        leaf = {"a": leaf}
    return leaf


def path(parts: int) -> str:
    return ".".join(["device", *["a"] * (parts - 1)])


DEEP: list[tuple[str, str, Any]] = [
    ("a device", "/api/v1/benches", {"scenario": {"device": nested(500)}}),
    ("a device of a run", "/api/v1/runs", {"scenario": {"device": nested(60)}}),
    ("a path", "/api/v1/benches", {"scenario": "first-look", "set": {path(500): 1}}),
    ("a path and a value", "/api/v1/benches", {"scenario": "first-look", "set": {path(30): nested(30)}}),
    ("a dotted key in TOML", "/api/v1/benches", {"scenario": f"{path(500)} = 1"}),
    ("a header in TOML", "/api/v1/scenarios/check", {"scenario": f"[{path(60)}]\nx = 1"}),
    ("lists in TOML", "/api/v1/scenarios/check", {"scenario": "x=" + "[" * 500}),
    ("inline tables in TOML", "/api/v1/scenarios/check", {"scenario": "x=" + "{a=" * 60 + "1" + "}" * 60}),
    ("a path of a grid", "/api/v1/sweeps", {"sweep": {"scenario": "first-look", "grid": {path(500): [1]}}}),
    ("a campaign in TOML", "/api/v1/sweeps", {"sweep": "x=" + "[" * 500}),
    ("a design", "/api/v1/devices/evaluate", {"device": nested(900)}),
]


def test_a_document_nested_too_deeply(live: Any) -> None:
    bench = live.bench()
    with failing() as case:
        for what, route, body in DEEP:
            with case(what):
                answer = live.http.post(route, json=body)
                check(answer, 422 if answer.status_code == 422 else 400, None, "nested too deeply", "at most 50 levels")
    runs_on(live, bench)


@pytest.mark.parametrize("levels", [60, 900])
def test_a_command_nested_too_deeply(live: Any, levels: int) -> None:
    bench = live.bench()
    commands = f"/api/v1/benches/{bench['id']}/commands"
    for kind in ("set", "reset"):
        deep = live.http.post(commands, json={"kind": kind, "values": {"sensor.noise_um": nested(levels)}})
        check(deep, 400, "malformed", "at most 50 levels")
        check(live.command(bench["id"], kind, values={path(levels): 1}), 422, "too_deep", "at most 50 levels")
    variant = live.http.post(f"/api/v1/benches/{bench['id']}/variant", json={"set": {"device": nested(levels)}})
    check(variant, 400, "malformed", "at most 50 levels")
    with live.stream(bench["id"]) as stream:
        command = {"set": {"sensor.noise_um": nested(levels)}}
        stream.send(type="command", id="deep", command=command)
        assert "at most 50 levels" in stream.until_type("error")["error"]["message"]
        assert stream.command(set={path(levels): 1})["error"]["code"] == "too_deep"
        assert stream.command("time_scale", value=0.002)["ok"]
    runs_on(live, bench)


def test_the_deepest_document_goes_beyond_the_first_check(live: Any) -> None:
    answer = live.http.post("/api/v1/scenarios/check", json={"scenario": {"device": nested(47)}})
    check(answer, 422, "unknown", "device.a")
    answer = live.http.post("/api/v1/benches", json={"scenario": "first-look", "set": {path(50): 1}})
    check(answer, 422, "unknown", "device.a")


def test_a_key_of_very_many_parts_takes_no_time(live: Any) -> None:
    """The budget of each test in processor time is its measure."""
    for key in ("a." * 300_000 + "a", '"a".' * 150_000 + "a"):
        check(live.http.post("/api/v1/scenarios/check", json={"scenario": f"{key} = 1"}), 422, "too_deep", "50 levels")


def test_a_layout_that_could_not_be_read_back_is_not_kept(live: Any) -> None:
    bench = live.bench()
    recordings = f"/api/v1/benches/{bench['id']}/recordings"
    for layout, status, words in (
        (nested(300), 400, ["nested too deeply"]),
        (nested(60), 400, ["nested too deeply"]),
        ({"text": "x" * 300_000}, 422, ["layout", "200000"]),
    ):
        check(live.http.post(recordings, json={"name": "x", "ticks": 10, "layout": layout}), status, None, *words)
    half = (r'{"layout": {"a": "\ud800"}}', r'{"layout": {"\udc00": 1}}')
    for text in half:
        check(live.http.post(recordings, content=text, headers=JSON), 400, "malformed", "letter")
    assert live.http.get(recordings).json()["recordings"] == []
    runs_on(live, bench)


def test_a_layout_is_read_back_as_it_was(live: Any) -> None:
    bench = live.bench()
    layout = nested(48, "\N{GRINNING FACE}")
    body = {"name": "x", "ticks": 10, "layout": layout}
    made = live.http.post(f"/api/v1/benches/{bench['id']}/recordings", json=body)
    assert made.status_code == 201
    assert live.http.get(f"/api/v1/recordings/{made.json()['id']}").json()["layout"] == layout


def test_half_a_letter_in_a_message_is_answered(live: Any) -> None:
    bench = live.bench()
    with live.stream(bench["id"]) as stream:
        stream.connection.send(json.dumps({"type": "command", "id": "\ud800", "command": {"kind": "pause"}}))
        assert stream.until_type("error")["error"]["code"] == "malformed"
        assert stream.command("time_scale", value=0.002)["ok"]
    runs_on(live, bench)
