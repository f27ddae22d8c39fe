"""Bad input: one clear line each, and the bench runs on."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed


def check(answer: Any, status: int, code: str | None, *words: str) -> None:
    """One error in the one shape, in one line that names the fault."""
    assert answer.status_code == status, answer.text
    assert set(answer.json()) == {"error"}
    error = answer.json()["error"]
    assert set(error) == {"code", "message", "field", "hint"}
    assert error["message"] and "\n" not in error["message"] and len(error["message"]) < 500
    if code is not None:
        assert error["code"] == code, error
    for word in words:
        assert word in error["message"] + error["hint"], error


def runs_on(live: Any, bench: dict[str, Any]) -> None:
    """The bench is running and moves."""
    before = live.get(bench["id"])
    assert before["state"] == "running"
    assert live.advance(seconds=0.1)[bench["id"]] > before["tick"]


@contextmanager
def failing() -> Iterator[Callable[[str], AbstractContextManager[None]]]:
    """Try cases one by one, and name each that fails."""
    failed: list[str] = []

    @contextmanager
    def case(name: str) -> Iterator[None]:
        try:
            yield
        except AssertionError as error:
            failed.append(f"{name}: {error}")

    yield case
    assert failed == []


SCENARIO = {"schema": 1, "id": "mine", "sample_rate_khz": 50, "samples": 1000}

SCENARIOS: list[tuple[str, Any, str | None, list[str]]] = [
    ("unknown field", {**SCENARIO, "colour": "red"}, "unknown", ["colour"]),
    (
        "unknown field inside",
        {**SCENARIO, "sensor": {"kind": "ideal", "nois_um": 1}},
        "unknown",
        ["sensor.nois_um", "noise_um"],
    ),
    ("wrong type", {**SCENARIO, "samples": "many"}, None, ["samples"]),
    ("wrong type inside", {**SCENARIO, "sensor": {"kind": "ideal", "noise_um": []}}, None, ["sensor.noise_um"]),
    ("wrong unit", {**SCENARIO, "sensor": {"kind": "ideal", "noise_nm": 50}}, "unit", ["noise_um"]),
    ("out of range", {**SCENARIO, "sensor": {"kind": "ideal", "noise_um": -1}}, None, ["sensor.noise_um", ">= 0"]),
    ("unknown controller", {**SCENARIO, "controller": {"kind": "magic"}}, "unknown", ["magic", "open_loop"]),
    ("not a table", {**SCENARIO, "sensor": 7}, None, ["sensor", "table"]),
    ("a list for a name", {**SCENARIO, "device": {"id": [1]}}, "unknown", ["device.id"]),
    ("stiff beyond reason", {**SCENARIO, "device": {"stiffness_n_m": 1e300}}, None, ["device.stiffness_n_m", "<="]),
    ("a share of nothing", {**SCENARIO, "metrics": {"tail_share": 0}}, None, ["metrics.tail_share", "> 0"]),
    ("a name twice", {**SCENARIO, "identifiers": {"pid": {"kind": "excitation"}}}, None, ["identifiers.pid"]),
    ("unknown library id", "ch5-seven-stepp", "unknown", ["ch5-seven-step"]),
    ("malformed TOML", "schema = 1\nid = [", "malformed", ["TOML"]),
    ("path traversal", "../../etc/passwd", "unknown", []),
    ("not a scenario", 7, None, ["scenario"]),
    (
        "an event with an unknown fault",
        {**SCENARIO, "events": [{"at_sample": 1, "fault": "rust", "severity": 1}]},
        "unknown",
        ["rust", "events.0"],
    ),
]


@pytest.mark.parametrize("path", ["/api/v1/benches", "/api/v1/runs", "/api/v1/scenarios/check"])
def test_a_wrong_scenario(live: Any, path: str) -> None:
    bench = live.bench()
    with failing() as case:
        for what, scenario, code, words in SCENARIOS:
            with case(what):
                check(live.http.post(path, json={"scenario": scenario}), 422, code, *words)
    runs_on(live, bench)


BODIES: list[tuple[str, bytes, int, str, list[str]]] = [
    ("unknown field", b'{"scenario": "ch5-seven-step", "colour": 1}', 422, "unknown_field", ["colour"]),
    ("missing field", b"{}", 422, "invalid", ["scenario", "required"]),
    ("wrong type", b'{"scenario": "ch5-seven-step", "paused": "yes"}', 422, "invalid", ["paused"]),
    ("one of two types", b'{"scenario": 7}', 422, "invalid", ["scenario: should be a valid string or a valid dict"]),
    ("number as text", b'{"scenario": "ch5-seven-step", "seed": "1"}', 422, "invalid", ["seed"]),
    ("out of range", b'{"scenario": "ch5-seven-step", "time_scale": 5}', 422, "invalid", ["time_scale", "1"]),
    ("not live path", b'{"scenario": "ch5-seven-step", "set": {"a.b": 1}}', 422, "unknown", ["a"]),
    ("lead", b'{"scenario": "ch5-seven-step", "quiet_lead": 1}', 422, "invalid", ["quiet_lead", "boolean"]),
    (
        "lead without a pace",
        b'{"scenario": "ch5-seven-step", "quiet_lead": true, "time_scale": null}',
        422,
        "invalid",
        ["quiet_lead", "time_scale"],
    ),
    ("NaN", b'{"scenario": "ch5-seven-step", "time_scale": NaN}', 400, "malformed", ["NaN"]),
    ("Infinity", b'{"scenario": "first-look", "set": {"sensor.noise_um": Infinity}}', 400, "malformed", ["Infinity"]),
    ("overflow", b'{"scenario": "ch5-seven-step", "time_scale": 1e999}', 400, "malformed", ["1e999"]),
    ("double key", b'{"scenario": "a", "scenario": "b"}', 400, "malformed", ["twice"]),
    ("malformed JSON", b'{"scenario": ', 400, "malformed", ["JSON"]),
    ("not UTF-8", b'{"scenario": "\xff"}', 400, "malformed", ["UTF-8"]),
    ("not an object", b"[1, 2]", 422, "invalid", ["object"]),
    ("nothing", b"", 422, "invalid", ["object"]),
    ("too deep", b"[" * 100_000, 400, "malformed", []),
    ("10 MB", b'{"scenario": "' + b"a" * (10 << 20) + b'"}', 413, "too_large", ["1048576"]),
]  # fmt: skip


def test_a_wrong_body(live: Any) -> None:
    def pieces() -> Any:
        yield b'{"scenario": "'
        for _ in range(160):
            yield b"a" * 65536

    bench, headers = live.bench(), {"Content-Type": "application/json"}
    with failing() as case:
        for what, body, status, code, words in BODIES:
            with case(what):
                check(live.http.post("/api/v1/benches", content=body, headers=headers), status, code, *words)
        with case("10 MB without a length"):
            check(live.http.post("/api/v1/benches", content=pieces(), headers=headers), 413, "too_large")
    runs_on(live, bench)


def test_a_body_that_is_not_json(live: Any) -> None:
    answer = live.http.post("/api/v1/benches", content=b"scenario=x", headers={"Content-Type": "text/plain"})
    check(answer, 422, "invalid", "object", "application/json")


COMMANDS: list[tuple[str, dict[str, Any], str, list[str]]] = [
    ("unknown command", {"kind": "explode"}, "unknown", ["explode", "inject"]),
    ("unknown fault", {"fault": "rust", "severity": 1}, "unknown", ["rust", "added_mass"]),
    ("unknown controller", {"switch": "magic"}, "unknown", ["magic", "mrac"]),
    ("wrong type", {"fault": "damping", "severity": "heavy"}, "invalid", ["severity"]),
    ("one of two types", {"heal": 5}, "invalid", ["heal: must be a list or one of 'all'"]),
    ("a wrong entry", {"heal": [5]}, "invalid", ["heal.0: must be a text"]),
    ("unknown field", {"switch": "pid", "fast": True}, "unknown", ["fast"]),
    ("healing what is not there", {"heal": ["damping"]}, "conflict", ["damping", "not there"]),
    ("not live", {"set": {"sample_rate_khz": 10}}, "not_live", ["sample_rate_khz"]),
    ("unknown path", {"set": {"sensor.colour": 1}}, "unknown", ["sensor.colour"]),
    ("out of range", {"set": {"sensor.noise_um": -3}}, "invalid", ["sensor.noise_um"]),
    ("in the past", {"switch": "pid", "at_sample": 0}, "invalid", ["passed"]),
    ("a condition on nothing", {"heal": "all", "when": "moon > 1"}, "unknown", ["moon"]),
    ("time scale", {"kind": "time_scale", "value": 0}, "invalid", ["value"]),
]


def test_a_wrong_command(live: Any) -> None:
    bench = live.bench(set={"events": []}, time_scale=0.02)
    runs_on(live, bench)
    with live.stream(bench["id"]) as stream, failing() as case:
        for what, command, code, words in COMMANDS:
            with case(what):
                before = live.get(bench["id"])["parameters"]
                check(live.command(bench["id"], **command), 422, code, *words)
                reply = stream.command(**command)
                assert reply["ok"] is False and reply["error"]["code"] == code
                assert all(word in reply["error"]["message"] + reply["error"]["hint"] for word in words)
                assert live.get(bench["id"])["parameters"] == before
    runs_on(live, bench)


def test_a_fault_twice(live: Any) -> None:
    bench = live.bench(set={"events": []})
    assert live.command(bench["id"], fault="added_mass", severity=0.05).status_code == 200
    again = live.command(bench["id"], fault="added_mass", severity=0.05)
    check(again, 422, "conflict", "added_mass", "already")
    assert len(live.get(bench["id"])["faults"]) == 1
    runs_on(live, bench)


MESSAGES: list[tuple[str, str | bytes, str, list[str]]] = [
    ("not JSON", "hello", "malformed", ["JSON"]),
    ("binary", b"\x01\x02", "malformed", ["text"]),
    ("NaN", '{"type": "ack", "frame": NaN}', "malformed", ["NaN"]),
    ("not an object", "[1]", "invalid", ["a message", "object"]),
    ("nothing", "null", "invalid", ["a message", "object"]),
    ("a text", '"x"', "invalid", ["a message", "object"]),
    ("no type", "{}", "invalid", ["type"]),
    ("unknown type", '{"type": "shout"}', "invalid", ["type", "subscribe"]),
    ("unknown field", '{"type": "ack", "frame": 1, "x": 2}', "unknown_field", ["x"]),
    ("wrong type", '{"type": "ack", "frame": "1"}', "invalid", ["frame"]),
    ("unknown signal", '{"type": "subscribe", "panel": 1, "signals": ["moon"], "window_ms": 1}', "unknown", ["moon"]),
    ("no window", '{"type": "subscribe", "panel": 1, "signals": ["plant.velocity"]}', "invalid", ["window_ms"]),
    (
        "empty span",
        '{"type": "subscribe", "panel": 1, "signals": ["plant.velocity"], "mode": "frozen", '
        '"start_tick": 5, "end_tick": 5}',
        "invalid",
        ["start_tick"],
    ),
    (
        "too wide",
        '{"type": "subscribe", "panel": 1, "signals": ["plant.velocity"], "window_ms": 1, "width": 100000}',
        "invalid",
        ["width", "4096"],
    ),
    (
        "no trigger",
        '{"type": "subscribe", "panel": 1, "signals": ["plant.velocity"], "mode": "triggered", "window_ms": 1}',
        "invalid",
        ["trigger"],
    ),
    ("rearm nothing", '{"type": "rearm", "panel": 9}', "invalid", ["panel 9"]),
    ("an unknown command without an id", '{"type": "command", "command": {"kind": "explode"}}', "invalid", ["id"]),
]  # fmt: skip


def test_a_wrong_message(live: Any) -> None:
    bench = live.bench()
    with live.stream(bench["id"]) as stream, failing() as case:
        for what, text, code, words in MESSAGES:
            with case(what):
                stream.connection.send(text)
                error = stream.until_type("error")["error"]
                assert error["code"] == code, error
                assert "\n" not in error["message"]
                assert all(word in error["message"] for word in words), error
                stream.send(type="subscribe", panel=1, signals=["plant.displacement"], window_ms=1.0)
                assert stream.until_frame(1)
    runs_on(live, bench)


def test_a_trigger_on_a_signal_that_is_not_there(live: Any) -> None:
    bench = live.bench()
    with live.stream(bench["id"]) as stream:
        shown = {"panel": 1, "signals": ["plant.velocity"], "window_ms": 1.0, "mode": "triggered"}
        stream.send(type="subscribe", **shown, trigger={"signal": "moon"})
        error = stream.until_type("error")["error"]
        assert (error["code"], error["field"]) == ("unknown", "trigger.signal") and "moon" in error["message"]
        stream.send(type="subscribe", **{**shown, "signals": ["moon"]}, trigger={"signal": "moon"})
        assert stream.until_type("error")["error"]["field"] == "signals"


def test_a_message_of_1_mb(live: Any) -> None:
    bench = live.bench()
    with live.stream(bench["id"]) as stream, pytest.raises(ConnectionClosed) as caught:
        stream.connection.send("x" * (1 << 20))
        stream.until(lambda _: False)
    assert caught.value.rcvd is None or caught.value.rcvd.code == 1009
    runs_on(live, bench)


def test_1000_commands_in_a_second(serve: Any) -> None:
    with serve(command_rate_per_s=20.0, command_burst=40) as live:
        bench = live.bench(set={"events": []})
        with live.stream(bench["id"]) as stream:
            for number in range(1000):
                command = {"kind": "time_scale", "value": 0.002}
                stream.send(type="command", id=f"n{number}", command=command)
            replies: dict[str, dict[str, Any]] = {}
            while len(replies) < 1000:
                message = stream.until_type("reply")
                replies[message["id"]] = message
            done = [reply for reply in replies.values() if reply["ok"]]
            refused = [reply for reply in replies.values() if not reply["ok"]]
            assert len(done) == 40
            assert {reply["error"]["code"] for reply in refused} == {"rate_limited"}
            assert "20 commands per second" in refused[0]["error"]["message"]
        runs_on(live, bench)
        live.advance(seconds=1.0)
        answers = [live.command(bench["id"], "time_scale", value=0.002) for _ in range(100)]
        assert sum(answer.status_code == 200 for answer in answers) < 100
        refused_http = [answer for answer in answers if answer.status_code != 200]
        assert refused_http
        check(refused_http[0], 429, "rate_limited", "20 commands per second")
        assert refused_http[0].headers["retry-after"] == "1"


def test_messages_without_end(live: Any) -> None:
    bench = live.bench()
    with live.stream(bench["id"]) as stream, pytest.raises(ConnectionClosed) as caught:
        for _ in range(20_000):
            stream.connection.send('{"type": "ack", "frame": 0}')
        stream.until(lambda _: False)
    assert caught.value.rcvd is None or caught.value.rcvd.code == 1008
    runs_on(live, bench)


ABSENT: list[tuple[str, str, int]] = [
    ("GET", "/api/v1/nothing", 404),
    ("GET", "/api/v1/benches/none", 404),
    ("DELETE", "/api/v1/benches/none", 404),
    ("GET", "/api/v1/benches/none/trace", 404),
    ("POST", "/api/v1/benches/none/snapshots", 404),
    ("GET", "/api/v1/runs/none", 404),
    ("GET", "/api/v1/runs/..%2f..%2fetc/trace", 404),
    ("GET", "/api/v1/recordings/none", 404),
    ("GET", "/api/v1/recordings/none/trace", 404),
    ("GET", "/api/v1/scenarios/none", 404),
    ("PATCH", "/api/v1/benches", 405),
    ("POST", "/api/v1/catalog", 405),
    ("GET", "/api/v1/catalog?family=magic", 422),
    ("POST", "/", 405),
    ("GET", "/health/nothing", 404),
    ("GET", "/assets/nothing.js", 404),
    ("GET", "/assets/%2e%2e/%2e%2e/pyproject.toml", 404),
]


def test_what_is_not_there(live: Any) -> None:
    with failing() as case:
        for method, path, status in ABSENT:
            with case(f"{method} {path}"):
                answer = live.http.request(method, path)
                assert answer.status_code == status, answer.text
                assert set(answer.json()["error"]) == {"code", "message", "field", "hint"}


QUESTIONS: list[tuple[dict[str, Any], str]] = [
    ({"signals": "moon"}, "moon"),
    ({"columns": 0}, "columns"),
    ({"columns": 10**6}, "columns"),
    ({"format": "exe"}, "format"),
    ({"start_tick": 5, "end_tick": 5}, "empty"),
    ({"start_tick": "abc"}, "start_tick"),
    ({"start_tick": -(10**30)}, "start_tick"),
    ({"start_tick": 10**9, "end_tick": 10**9 + 5, "format": "csv"}, "kept"),
]


def test_a_wrong_question_about_the_past(live: Any) -> None:
    bench = live.bench()
    with failing() as case:
        for query, word in QUESTIONS:
            with case(str(query)):
                check(live.http.get(f"/api/v1/benches/{bench['id']}/trace", params=query), 422, None, word)
    runs_on(live, bench)


def test_an_error_nobody_expected_is_told_in_the_same_shape(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> Any:
        raise RuntimeError("broken on purpose")

    monkeypatch.setattr(live.service.benches, "all", broken)
    answer = live.http.get("/api/v1/benches")
    check(answer, 500, "internal")
    assert "broken on purpose" not in answer.text
    assert json.loads(answer.text)


def test_one_bench_too_many(serve: Any) -> None:
    with serve(max_benches=2, max_snapshots=1) as live:
        first, _ = live.bench(), live.bench()
        answer = live.http.post("/api/v1/benches", json={"scenario": "ch5-seven-step"})
        check(answer, 409, "too_many_benches", "2", "max_benches")
        check(live.http.post(f"/api/v1/benches/{first['id']}/fork", json={}), 409, "too_many_benches")
        assert live.http.post(f"/api/v1/benches/{first['id']}/snapshots").status_code == 201
        answer = live.http.post(f"/api/v1/benches/{first['id']}/snapshots")
        check(answer, 409, "too_many_snapshots", "max_snapshots")
        runs_on(live, first)
        live.http.delete(f"/api/v1/benches/{first['id']}")
        live.bench()


def test_one_stream_too_many(serve: Any) -> None:
    with serve(max_clients_per_bench=1) as live:
        bench = live.bench()
        with live.stream(bench["id"]) as stream:
            stream.step()
            with live.stream(bench["id"]) as second, pytest.raises(ConnectionClosed) as caught:
                second.step()
            assert caught.value.rcvd is not None and caught.value.rcvd.code == 1013
            assert "max_clients_per_bench" in caught.value.rcvd.reason
            stream.until_type("status")


def test_a_controller_from_outside_cannot_be_had_over_the_network(live: Any) -> None:
    outside = {"schema": 1, "controller": {"kind": "external"}}
    for path, body in (("benches", {"scenario": outside}), ("runs", {"scenario": outside})):
        answer = live.http.post(f"/api/v1/{path}", json=body)
        assert answer.status_code == 422 and answer.json()["error"]["field"].endswith("controller.kind"), answer.text
    bench = live.bench("first-look", paused=True)["id"]
    for command in ({"switch": "external"}, {"set": {"controller.kind": "external"}}):
        answer = live.command(bench, **command)
        assert answer.status_code == 422 and "is not on this bench" in answer.json()["error"]["message"]
    assert "external" not in {card["name"] for card in live.http.get("/api/v1/catalog").json()["blocks"]}
