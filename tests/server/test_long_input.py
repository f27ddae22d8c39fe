"""Numbers and names of thousands of characters: refused in one short line."""

from __future__ import annotations

from typing import Any

import pytest

from tests.server.test_bad_input import check

DIGITS = "1" * 5000
"""A whole number of more digits than Python reads."""


@pytest.mark.parametrize(
    ("method", "path", "body"),
    [
        ("POST", "/api/v1/benches", {"scenario": f"schema = 1\nseed = {DIGITS}"}),
        ("POST", "/api/v1/runs", {"scenario": f"schema = 1\nsamples = {DIGITS}"}),
        ("POST", "/api/v1/sweeps", {"sweep": f"schema = 1\nseeds.first = {DIGITS}"}),
        ("POST", "/api/v1/scenarios/check", {"scenario": f"schema = 1\nseed = {DIGITS}"}),
        ("GET", f"/api/v1/benches/nowhere/events?after={DIGITS}", None),
        ("GET", f"/api/v1/benches/nowhere/trace?start_tick=-{DIGITS}", None),
    ],
)
def test_a_number_of_thousands_of_digits_is_refused(live: Any, method: str, path: str, body: Any) -> None:
    answer = live.http.request(method, path, json=body)
    assert answer.status_code in (404, 422), answer.text
    check(answer, answer.status_code, None)


def test_a_number_of_thousands_of_digits_in_json_is_refused(live: Any) -> None:
    text = '{"scenario": "first-look", "seed": ' + DIGITS + "}"
    answer = live.http.post("/api/v1/runs", content=text, headers={"Content-Type": "application/json"})
    check(answer, 400, "malformed")


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("/api/v1/benches", {"scenario": "first-look", "x" * 500_000: 1}),
        ("/api/v1/benches", {"scenario": {"x" * 500_000: 1}}),
        ("/api/v1/benches", {"scenario": "first-look", "set": {"x" * 500_000: 1}}),
        ("/api/v1/runs", {"scenario": "x" * 500_000}),
        ("/api/v1/sweeps", {"sweep": {"schema": 1, "scenario": "first-look", "grid": {"x" * 500_000: [1]}}}),
        ("/api/v1/devices/evaluate", {"x" * 500_000: 1}),
        ("/api/v1/theory/positive-real", {"x" * 500_000: 1}),
        ("/api/v1/gallery/run", {"only": "x" * 500_000}),
    ],
)
def test_what_a_caller_wrote_is_told_back_in_part(live: Any, path: str, body: Any) -> None:
    answer = live.http.post(path, json=body)
    assert answer.status_code in (404, 422) and len(answer.content) < 2000, len(answer.content)
    error = answer.json()["error"]
    assert all(len(error[name]) <= 300 for name in ("message", "field", "hint"))


def test_a_whole_number_may_be_written_with_a_point(live: Any) -> None:
    """JSON Schema calls 7.0 an integer, and so the document of the interface does."""
    made = live.http.post("/api/v1/benches", json={"scenario": "first-look", "seed": 7.0})
    assert made.status_code == 201 and made.json()["seed"] == 7
    check(live.http.post("/api/v1/benches", json={"scenario": "first-look", "seed": 7.5}), 422, None, "seed")
