"""A second bench that is set as the first, but for some values."""

from __future__ import annotations

from typing import Any

from tests.lab import RICH

WATCHED = {**RICH, "schema": 1, "id": "watched", "title": "Watched", "events": [{"at_sample": 50, "heal": "all"}]}


def vary(live: Any, bench: Any, **values: Any) -> Any:
    return live.http.post(f"/api/v1/benches/{bench['id']}/variant", json={"set": values})


def test_a_variant_has_the_live_changes_and_meets_the_same_noise(live: Any) -> None:
    bench = live.bench(WATCHED, paused=True)
    live.command(bench["id"], set={"sensor.noise_um": 0.07})
    live.command(bench["id"], fault="added_mass", severity=0.1)
    live.command(bench["id"], "step", ticks=100)
    made = vary(live, bench, **{"diagnosers.kalman.assumed_noise_scale": 3.0}).json()
    assert made["id"] != bench["id"] and made["tick"] == 0 and made["state"] == "paused"
    assert made["title"] == bench["title"] and made["seed"] == bench["seed"]
    assert made["parameters"]["sensors"]["ideal"]["noise_um"] == 0.07
    assert made["parameters"]["diagnosers"]["kalman"]["assumed_noise_scale"] == 3.0
    assert made["faults"] == [] and len(made["pending"]) == 1  # past commands are not repeated, the story is

    live.command(made["id"], fault="added_mass", severity=0.1)
    live.command(made["id"], "step", ticks=100)
    query = {"signals": "sensor.displacement", "start_tick": 0, "end_tick": 100, "columns": 100}
    first, second = (
        live.http.get(f"/api/v1/benches/{one['id']}/trace", params=query).json()["signals"] for one in (bench, made)
    )
    assert first == second


def test_a_variant_may_have_twins_and_other_hypotheses(live: Any) -> None:
    bench = live.bench(WATCHED, paused=True)
    twins = {"adaptive": {"controller": {"kind": "mrac"}}}
    made = vary(live, bench, twins=twins).json()
    assert made["parameters"]["twins"] == twins
    names = {signal["name"] for signal in made["signals"]}
    assert {"adaptive:plant.displacement", "adaptive:mrac.voltage", "adaptive:kalman.winner"} <= names

    two = [{"name": "healthy"}, {"name": "k+5", "stiffness": 1.05}]
    again = vary(live, made, **{"diagnosers.kalman.hypotheses": two, "twins": {}}).json()
    assert again["diagnosers"]["kalman"]["names"] == ["healthy", "k+5"]
    assert not any(":" in signal["name"] for signal in again["signals"])

    refused = vary(live, bench, twins={"one": {"device": {"mass_kg": 1.0}}})
    assert refused.status_code == 422 and refused.json()["error"]["field"] == "twins.one.device"
