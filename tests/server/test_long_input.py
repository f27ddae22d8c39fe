"""Numbers and names of thousands of characters: refused in one short line."""

from __future__ import annotations

from typing import Any

from tests.server.test_bad_input import check, failing

DIGITS = "1" * 5000
"""A whole number of more digits than Python reads."""


def test_a_number_of_thousands_of_digits_is_refused(live: Any) -> None:
    asked: list[tuple[str, str, Any]] = [
        ("POST", "/api/v1/benches", {"scenario": f"schema = 1\nseed = {DIGITS}"}),
        ("POST", "/api/v1/runs", {"scenario": f"schema = 1\nsamples = {DIGITS}"}),
        ("POST", "/api/v1/sweeps", {"sweep": f"schema = 1\nseeds.first = {DIGITS}"}),
        ("POST", "/api/v1/scenarios/check", {"scenario": f"schema = 1\nseed = {DIGITS}"}),
        ("GET", f"/api/v1/benches/nowhere/events?after={DIGITS}", None),
        ("GET", f"/api/v1/benches/nowhere/trace?start_tick=-{DIGITS}", None),
    ]
    with failing() as case:
        for method, path, body in asked:
            with case(path[:40]):
                answer = live.http.request(method, path, json=body)
                assert answer.status_code in (404, 422), answer.text
                check(answer, answer.status_code, None)
    text = '{"scenario": "first-look", "seed": ' + DIGITS + "}"
    answer = live.http.post("/api/v1/runs", content=text, headers={"Content-Type": "application/json"})
    check(answer, 400, "malformed")


def test_what_a_caller_wrote_is_told_back_in_part(live: Any) -> None:
    long = "x" * 500_000
    asked: list[tuple[str, Any]] = [
        ("benches", {"scenario": "first-look", long: 1}),
        ("benches", {"scenario": {long: 1}}),
        ("benches", {"scenario": "first-look", "set": {long: 1}}),
        ("runs", {"scenario": long}),
        ("sweeps", {"sweep": {"schema": 1, "scenario": "first-look", "grid": {long: [1]}}}),
        ("devices/evaluate", {long: 1}),
        ("theory/positive-real", {long: 1}),
        ("gallery/run", {"only": long}),
    ]
    with failing() as case:
        for path, body in asked:
            with case(f"{path} {list(body)[-1][:9]}"):
                answer = live.http.post(f"/api/v1/{path}", json=body)
                assert answer.status_code in (404, 422) and len(answer.content) < 2000, len(answer.content)
                error = answer.json()["error"]
                assert all(len(error[name]) <= 300 for name in ("message", "field", "hint"))


def test_a_whole_number_may_be_written_with_a_point(live: Any) -> None:
    """JSON Schema calls 7.0 an integer, and so the document of the interface does."""
    made = live.http.post("/api/v1/benches", json={"scenario": "first-look", "seed": 7.0})
    assert made.status_code == 201 and made.json()["seed"] == 7
    check(live.http.post("/api/v1/benches", json={"scenario": "first-look", "seed": 7.5}), 422, None, "seed")
