"""Thresholds over REST: queued, found as on the command line, cancelled."""

from __future__ import annotations

from typing import Any

from scenarios.campaign.halving import ThresholdGoal
from scenarios.campaign.threshold import ResultMemory, Search
from scenarios.library import get

NAME = "ch3-case1-aged-mass"
ASKED = {"metric": "control.effort_ratio", "path": "events.1.severity", "low": 0.0, "high": 7.5}
PATH = "/api/v1/thresholds"


def done(live: Any, found: dict[str, Any]) -> dict[str, Any]:
    """Return a search once it has ended."""
    while found["state"] in ("queued", "running"):
        live.ended(found["id"])
        found = live.http.get(f"{PATH}/{found['id']}").json()
    return found


def test_a_threshold_is_found_as_it_is_headless(live: Any) -> None:
    answer = live.http.post(PATH, json={"scenario": NAME, **ASKED})
    assert answer.status_code == 202, answer.text
    found = done(live, answer.json())
    assert (found["state"], found["progress"], found["error"]) == ("done", 1.0, None)
    search = Search(get(NAME), ThresholdGoal(**ASKED), ResultMemory())
    search.run()
    assert found["found"] == search.kept
    # 80 % more effort belongs to a severity between the two
    begins, ends = found["found"]["turns"]
    assert (begins["begins"], ends["begins"]) == (True, False)
    again = live.http.post(PATH, json={"scenario": NAME, **ASKED})
    assert (again.status_code, again.json()["id"]) == (200, found["id"])
    # a bench has the scenario it began with
    bench = live.bench(NAME, paused=True)["id"]
    of_bench = live.http.post(PATH, json={"bench": bench, **ASKED})
    assert of_bench.json()["id"] == found["id"]


def test_it_can_be_cancelled(live: Any) -> None:
    asked = {"scenario": "ch5-three-way", "metric": "diagnosis.kalman.delay_samples.2", "path": "sensor.noise_um"}
    found = live.http.post(PATH, json={**asked, "low": 0.01, "high": 1.0, "points": 65}).json()
    ended = live.http.delete(f"{PATH}/{found['id']}")
    assert ended.status_code in (200, 409)
    assert done(live, live.http.get(f"{PATH}/{found['id']}").json())["state"] in ("cancelled", "done")


def test_what_cannot_be_looked_for_is_one_line(live: Any) -> None:
    for change, field in (
        ({"metric": "control.nothing"}, "metric"),
        ({"path": "events.7.severity"}, "low"),
        ({"high": 1e9}, "high"),
        ({"low": 9.0}, ""),
        ({"points": 2}, "points"),
        ({"scenario": None}, ""),
        ({"bench": "nobody"}, ""),
    ):
        answer = live.http.post(PATH, json={"scenario": NAME, **ASKED, **change})
        assert answer.status_code == 422, answer.text
        error = answer.json()["error"]
        assert error["field"] == field and "\n" not in error["message"], change


def test_an_unknown_one_is_not_found(live: Any) -> None:
    assert live.http.get(f"{PATH}/nothing").status_code == 404
