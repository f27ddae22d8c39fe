"""A campaign of many points: refused at once or accepted at once, its points read in their turn."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from scenarios.campaign import points
from scenarios.campaign.campaign import Campaign
from scenarios.key import content_hash
from tests.server.test_bad_input import check

POINTS = 120
MANY: dict[str, Any] = {
    "schema": 1,
    "id": "many",
    "scenario": "first-look",
    "set": {"samples": 100},
    "grid": {"sensor.noise_um": [0.01 * number for number in range(1, POINTS + 1)]},
}


def ended(live: Any, sweep_id: str) -> dict[str, Any]:
    """Return a campaign once it has ended."""
    while True:
        live.ended(sweep_id)
        found: dict[str, Any] = live.http.get(f"/api/v1/sweeps/{sweep_id}").json()
        if found["state"] not in ("queued", "running"):
            return found


def test_results_of_many_points_are_as_of_few(live: Any) -> None:
    made = live.http.post("/api/v1/sweeps", json={"sweep": MANY})
    assert made.status_code == 202 and made.json()["runs"] == POINTS
    found = ended(live, made.json()["id"])
    assert found["state"] == "done" and found["done"] == POINTS
    answer = live.http.get(f"/api/v1/sweeps/{found['id']}/points").json()
    assert answer["sweep"]["id"] == found["id"]
    assert [point["labels"]["sensor.noise_um"] for point in answer["points"]] == MANY["grid"]["sensor.noise_um"]
    assert all(point["runs"] == 1 for point in answer["points"])


def test_the_picture_is_chosen_by_the_server_and_the_report_has_the_name_given(live: Any) -> None:
    small = {**MANY, "grid": {"sensor.noise_um": [0.01, 0.1], "reference.amplitude_um": [1.0, 2.0]}}
    made = live.http.post("/api/v1/sweeps", json={"sweep": small, "label": "Noise & <stroke>"}).json()
    address = f"/api/v1/sweeps/{ended(live, made['id'])['id']}"
    shown = live.http.get(f"{address}/picture").json()
    assert shown["kind"] == "map" and shown["figure"] == shown["figures"][0] and len(shown["parts"][0]["mean"]) == 4
    other = live.http.get(f"{address}/picture", params={"figure": "control.rms_error_um"}).json()
    assert other["figure"] == "control.rms_error_um" and other["figures"] == shown["figures"]
    assert other["low"] == 0.0
    check(live.http.get(f"{address}/picture", params={"figure": "control.nonsense"}), 422, "unknown", "figure")
    points = live.http.get(f"{address}/points").json()
    assert points["words"]["m+5"] == "mass +5\u00a0%"
    report = live.http.get(f"{address}/report").text
    assert "<h1>Noise &amp; &lt;stroke&gt;</h1>" in report and report.index("<svg") < report.index("<table")


def test_a_wrong_value_among_many_is_refused_at_once_and_so_is_what_is_too_long(live: Any) -> None:
    for noises in ([0.1, -1.0], [*MANY["grid"]["sensor.noise_um"], -1.0]):
        grid = {"sensor.noise_um": noises}
        check(live.http.post("/api/v1/sweeps", json={"sweep": {**MANY, "grid": grid}}), 422, "invalid", "noise_um")
    long = {**MANY, "set": {}, "grid": {"duration_ms": [1.0, 9e5, 2.0]}}
    check(live.http.post("/api/v1/sweeps", json={"sweep": long}), 422, "too_long", "max_run_ticks")


def test_a_point_that_cannot_be_carried_out_is_a_row_with_its_error(live: Any) -> None:
    """Each value is possible, two of them together are not: the campaign continues, and reports the error at that
    point."""
    grid = {"drive.kind": ["held", "analogue"], "controller.kind": ["open_loop", "mrac"]}
    made = live.http.post("/api/v1/sweeps", json={"sweep": {**MANY, "grid": grid}})
    assert made.status_code == 202
    found = ended(live, made.json()["id"])
    assert found["state"] == "done" and found["done"] == 4
    points = live.http.get(f"/api/v1/sweeps/{found['id']}/points").json()["points"]
    assert [len(point["errors"]) for point in points] == [0, 0, 0, 1]
    assert points[3]["errors"][0].startswith("drive.kind: analogue is for") and points[3]["runs"] == 1


def test_the_points_of_the_largest_campaign_are_read_in_their_turn(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 20 000 points none is hashed before the campaign is accepted, and few once it is cancelled."""
    hashed: list[int] = []
    cancelled = threading.Event()

    def hash_after_cancel(document: dict[str, Any]) -> str:
        hashed.append(1)
        cancelled.wait(120.0)
        return content_hash(document)

    def cancel(campaign: Campaign) -> None:
        end(campaign)
        cancelled.set()

    end = Campaign.cancel
    monkeypatch.setattr(points, "content_hash", hash_after_cancel)
    monkeypatch.setattr(Campaign, "cancel", cancel)
    hypercube = {"points": 20_000, "ranges": {"sensor.noise_um": {"min": 0.01, "max": 0.2}}}
    made = live.http.post("/api/v1/sweeps", json={"sweep": {**MANY, "grid": {}, "latin_hypercube": hypercube}})
    assert made.status_code == 202 and made.json()["runs"] == 20_000 and len(hashed) <= 1  # the first one waits
    answer = live.http.delete(f"/api/v1/sweeps/{made.json()['id']}")
    assert answer.json()["state"] == "cancelled" and len(hashed) < 5000


def test_a_hypercube_of_too_many_values_is_refused(live: Any) -> None:
    ranges = {f"sensor.noise_um{number}": {"min": 1, "max": 2} for number in range(51)}
    body = {"sweep": {**MANY, "grid": {}, "latin_hypercube": {"points": 20_000, "ranges": ranges}}}
    check(live.http.post("/api/v1/sweeps", json=body), 422, None, "latin_hypercube.ranges", "50")
