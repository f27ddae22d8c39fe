"""A campaign of many points: accepted at once, checked apart, and in nobody's way."""

from __future__ import annotations

import time
from typing import Any

import pytest

from scenarios.campaign import points
from server.runs import sweeps
from server.runs.apart import FEW_POINTS
from tests.server.test_bad_input import check

MANY: dict[str, Any] = {
    "schema": 1,
    "id": "many",
    "scenario": "first-look",
    "set": {"samples": 100},
    "grid": {"sensor.noise_um": [0.01 * number for number in range(1, FEW_POINTS + 6)]},
}


def ended(live: Any, sweep_id: str, seconds: float = 240.0) -> dict[str, Any]:
    end = time.monotonic() + seconds
    while (found := live.http.get(f"/api/v1/sweeps/{sweep_id}").json())["state"] in ("queued", "running"):
        assert time.monotonic() < end, found
        time.sleep(0.1)
    return dict(found)


def test_its_points_are_checked_after_it_is_accepted(live: Any) -> None:
    """No point is looked at in this process but the first few; results are as of a small one."""
    made = live.http.post("/api/v1/sweeps", json={"sweep": MANY})
    assert made.status_code == 202 and made.json()["runs"] == FEW_POINTS + 5
    found = ended(live, made.json()["id"])
    assert found["state"] == "done" and found["done"] == FEW_POINTS + 5
    answer = live.http.get(f"/api/v1/sweeps/{found['id']}/points").json()
    assert answer["sweep"]["id"] == found["id"]
    assert [point["labels"]["sensor.noise_um"] for point in answer["points"]] == MANY["grid"]["sensor.noise_um"]
    assert all(point["runs"] == 1 for point in answer["points"])


def test_a_wrong_point_among_many_fails_the_campaign_and_says_which_field(live: Any) -> None:
    noises = [*MANY["grid"]["sensor.noise_um"], -1.0]
    made = live.http.post("/api/v1/sweeps", json={"sweep": {**MANY, "grid": {"sensor.noise_um": noises}}})
    assert made.status_code == 202
    found = ended(live, made.json()["id"])
    assert found["state"] == "failed" and found["done"] == 0
    assert found["error"]["field"] == "sensor.noise_um" and ">= 0" in found["error"]["message"]


def test_one_of_few_is_refused_at_once_and_so_is_one_that_is_too_long(live: Any) -> None:
    for grid in ({"sensor.noise_um": [0.1, -1.0]}, {"sensor.noise_um": [-1.0, *MANY["grid"]["sensor.noise_um"]]}):
        check(live.http.post("/api/v1/sweeps", json={"sweep": {**MANY, "grid": grid}}), 422, "invalid", "noise_um")
    long = {**MANY, "set": {}, "grid": {"duration_ms": [1.0, 9e5]}}
    check(live.http.post("/api/v1/sweeps", json={"sweep": long}), 422, "too_long", "max_run_ticks")


def test_the_expansion_of_the_largest_campaign_is_left_to_another_process(
    live: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of 20 000 points this process checks the first few; the rest can be cancelled."""
    read: list[int] = []
    longest = sweeps.Sweep.longest
    monkeypatch.setattr(
        sweeps.Sweep, "longest", staticmethod(lambda points: (read.append(len(points)), longest(points))[1])
    )
    monkeypatch.setattr(points, "content_hash", lambda _: pytest.fail("hashed in this process"))
    hypercube = {"points": 20_000, "ranges": {"sensor.noise_um": {"min": 0.01, "max": 0.2}}}
    large = {**MANY, "grid": {}, "latin_hypercube": hypercube}
    made = live.http.post("/api/v1/sweeps", json={"sweep": large})
    assert made.status_code == 202 and made.json()["runs"] == 20_000
    assert read == [FEW_POINTS]
    cancelled = live.http.delete(f"/api/v1/sweeps/{made.json()['id']}")
    assert cancelled.json()["state"] == "cancelled"


def test_a_hypercube_of_too_many_values_is_refused(live: Any) -> None:
    ranges = {f"sensor.noise_um{number}": {"min": 1, "max": 2} for number in range(51)}
    body = {"sweep": {**MANY, "grid": {}, "latin_hypercube": {"points": 20_000, "ranges": ranges}}}
    check(live.http.post("/api/v1/sweeps", json=body), 422, None, "latin_hypercube.ranges", "50")
