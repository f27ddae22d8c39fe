"""Claims of a live bench: the measured figures equal the figures of a headless run, to the last bit."""

from __future__ import annotations

from typing import Any

import pytest

from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario
from tests.lab import QUIET

MOST_TICKS = 10_000
STEPS = "ch5-seven-step"


def claims(live: Any, bench: str) -> dict[str, Any]:
    answer = live.http.get(f"/api/v1/benches/{bench}/claims")
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def printed(live: Any, bench: str) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = live.http.get(f"/api/v1/benches/{bench}/printed").json()["marks"]
    return found


def measured(found: dict[str, Any]) -> dict[str, float]:
    return {claim["metric"]: claim["measured"] for claim in found["claims"]}


def expected(scenario: Scenario) -> dict[str, float | None]:
    metrics = run(scenario, figures_only=True).metrics
    return {entry.metric: metrics.get(entry.metric) for entry in scenario.head.expect}


def cut(scenario: Scenario, samples: int) -> Scenario:
    """The beginning of a scenario."""
    rest = {key: value for key, value in scenario.document.items() if key != "duration_ms"}
    return Scenario.load({**rest, "samples": samples})


def step(live: Any, bench: str, ticks: int) -> None:
    while ticks > 0:
        assert live.command(bench, "step", ticks=min(ticks, MOST_TICKS)).status_code == 200
        ticks -= MOST_TICKS


@pytest.mark.parametrize(
    "name", [STEPS, "ch5-weighted-output", "ch3-mrac-mass-x10", "ch3-stvsc-pull-in", "ch4-regulator"]
)
def test_at_the_end_every_figure_is_that_of_the_headless_run(live: Any, name: str) -> None:
    bench = live.bench(name, paused=True)["id"]
    whole = get(name)
    assert claims(live, bench)["tick"] == 0
    step(live, bench, (whole.samples or 0) // 3)
    early = claims(live, bench)
    assert {claim["state"] for claim in early["claims"]} == {"not yet"}
    assert early["verdict"] is None
    assert measured(early) == expected(cut(whole, early["tick"]))
    step(live, bench, whole.samples - early["tick"])
    found = claims(live, bench)
    result = run(whole, figures_only=True)
    assert (found["tick"], found["ends_at"], found["is_over"]) == (whole.samples, whole.samples, True)
    rows = result.expectations()
    assert measured(found) == {row["metric"]: row["measured"] for row in rows}
    assert [claim["verdict"] for claim in found["claims"]] == [row["verdict"] for row in rows]
    assert [claim["as_expected"] for claim in found["claims"]] == [row["ok"] for row in rows]
    step(live, bench, 500)
    assert measured(claims(live, bench)) == measured(found)


def test_what_is_done_by_hand_counts_and_a_reset_begins_anew(live: Any) -> None:
    bench = live.bench(STEPS, paused=True)["id"]
    step(live, bench, 1500)
    claims(live, bench)
    assert live.command(bench, fault="added_mass", severity=0.05).status_code == 200
    step(live, bench, 1000)
    found = claims(live, bench)
    saved = live.http.get(f"/api/v1/benches/{bench}/scenario").text
    again = run(Scenario.load(saved), figures_only=True)
    assert again.board.tick == found["tick"] == 2500
    assert measured(found) == {name: again.metrics.get(name) for name in measured(found)}
    assert measured(found) != expected(cut(get(STEPS), 2500))
    assert live.command(bench, "reset", values={}).status_code == 200
    step(live, bench, 2500)
    found = claims(live, bench)
    assert measured(found) == expected(cut(get(STEPS), 2500))


def test_marks_are_told_with_their_ticks(live: Any) -> None:
    bench = live.bench(STEPS, paused=True)["id"]
    found, drawn = claims(live, bench), printed(live, bench)
    assert [(mark["from_tick"], mark["until_tick"]) for mark in drawn][1:3] == [(2000, 3000), (3000, 4000)]
    first = found["claims"][0]
    assert first["metric"] == "diagnosis.kalman.correct_fraction"
    assert first["marks"] == drawn
    assert len(drawn) == 7
    assert (first["printed_low"], first["printed_high"], first["low"], first["high"]) == (0.95, 1.0, 0.98, None)


def test_a_run_that_stops_is_over(live: Any) -> None:
    document = {
        **QUIET,
        "samples": 4000,
        "guard": {"travel_um": 1.0},
        "expect": [{"metric": "control.peak_error_um", "max": 5.0}],
    }
    bench = live.bench(document, paused=True)["id"]
    step(live, bench, 4000)
    result = run(Scenario.load(document), figures_only=True)
    assert result.trip is not None
    found = claims(live, bench)
    assert found["tick"] == result.board.tick < 4000
    assert found["is_over"]
    assert measured(found) == expected(Scenario.load(document))


def test_numbers_to_turn_begin_with_what_was_fitted_and_severities(live: Any) -> None:
    found = claims(live, live.bench("ch3-mrac-mass-x10", paused=True)["id"])
    knobs = found["claims"][0]["knobs"]
    assert [knob["path"] for knob in knobs][:2] == ["controller.adaptation_gain", "events.0.severity"]
    assert (knobs[0]["value"], knobs[0]["is_fitted"], knobs[0]["is_live"]) == (0.1, True, True)
    assert (knobs[1]["value"], knobs[1]["fault"], knobs[1]["unit"]) == (9.0, "added_mass", "1")
    for claim in found["claims"]:
        assert all(knob["low"] < knob["high"] for knob in claim["knobs"])


def test_a_recording_that_is_played_is_not_measured(live: Any) -> None:
    bench = live.bench(STEPS, paused=True)["id"]
    recording = live.http.post(f"/api/v1/benches/{bench}/recordings", json={}).json()["id"]
    step(live, bench, 200)
    live.http.post(f"/api/v1/benches/{bench}/recordings/{recording}/stop")
    played = live.http.post(f"/api/v1/recordings/{recording}/replay", json={"speed": 1, "paused": True}).json()["id"]
    found = claims(live, played)
    assert "recording" in found["reason"]
    assert set(measured(found).values()) <= {None}


def test_what_was_hidden_is_withheld_and_then_cannot_be_told(live: Any) -> None:
    bench = live.bench(STEPS, paused=True)["id"]
    path = f"/api/v1/benches/{bench}"
    assert live.http.post(f"{path}/blind", json={"seed": 4}).status_code in (200, 201)
    refused = live.http.get(f"{path}/claims")
    assert (refused.status_code, refused.json()["error"]["code"]) == (403, "blind")
    assert live.http.get(f"{path}/printed").status_code == 403
    step(live, bench, 9_000)
    assert live.http.delete(f"{path}/blind").status_code in (200, 204)
    found = claims(live, bench)
    assert found["reason"] == "a change of this bench was no command, so its run cannot be repeated"
    assert live.command(bench, "reset", values={}).status_code == 200
    step(live, bench, 100)
    assert claims(live, bench)["reason"] == ""


def test_a_mark_of_another_signal_is_refused_where_a_scenario_is_checked(live: Any) -> None:
    mark = {
        "section": "9",
        "words": "2 micron",
        "number": "2",
        "signal": "plant.nothing",
        "unit": "um",
        "values": [2.0],
    }
    answer = live.http.post("/api/v1/scenarios/check", json={"scenario": {**QUIET, "printed": [mark]}})
    assert answer.status_code == 422
    assert answer.json()["error"]["field"] == "printed.0.signal"
    # a bench is opened all the same, and says that it cannot draw it
    bench = live.bench({**QUIET, "printed": [mark]}, paused=True)["id"]
    assert printed(live, bench)[0]["problem"] == "this bench has no signal plant.nothing"
