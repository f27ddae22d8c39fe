"""Named sets of parameters over REST: kept, put on another bench, compared, refused in one line."""

from __future__ import annotations

from typing import Any

SETS = "/api/v1/parameter-sets"


def keep(live: Any, bench: dict[str, Any], name: str) -> dict[str, Any]:
    answer = live.http.post(f"/api/v1/benches/{bench['id']}/parameter-sets", json={"name": name})
    assert answer.status_code == 201, answer.text
    found: dict[str, Any] = answer.json()
    return found


def test_a_set_goes_from_one_bench_to_another_and_is_undone(live: Any) -> None:
    one, other = live.bench(paused=True), live.bench(paused=True)
    usual = keep(live, one, "usual")
    live.command(one["id"], set={"drive.limit_v": 12.0, "reference.kind": "chirp"})
    mine = keep(live, one, "mine")
    differs = live.http.get(f"{SETS}/{usual['id']}/difference", params={"other": mine["id"]}).json()
    rows = {row["path"]: (row["first"], row["second"]) for row in differs["rows"]}
    assert rows["drive.limit_v"] == (30.0, 12.0) and rows["reference.kind"] == ("sine", "chirp")
    assert differs["same"] + len(differs["rows"]) == len({*usual["values"], *mine["values"]})

    path = f"/api/v1/benches/{other['id']}/parameter-sets/{mine['id']}"
    applied = live.http.post(path).json()
    assert applied["result"]["entry"]["kind"] == "set" and applied["left_out"] == []
    parameters = live.get(other["id"])["parameters"]
    assert parameters["drive"]["limit_v"] == 12.0 and parameters["reference"]["kind"] == "chirp"
    now = live.http.get(f"{SETS}/{mine['id']}/difference", params={"bench": other["id"]}).json()
    assert now["rows"] == []
    assert live.http.post(path).json()["result"] is None
    live.command(other["id"], "undo")
    assert live.get(other["id"])["parameters"]["reference"] == live.bench(paused=True)["parameters"]["reference"]


def test_sets_are_listed_renamed_deleted_and_outlive_their_bench(live: Any) -> None:
    bench = live.bench(paused=True)
    a, b = keep(live, bench, "b first"), keep(live, bench, "a second")
    live.http.delete(f"/api/v1/benches/{bench['id']}")
    names = [one["name"] for one in live.http.get(SETS).json()["sets"]]
    assert names == sorted(names) and {"a second", "b first"} <= {*names}
    assert live.http.patch(f"{SETS}/{a['id']}", json={"name": "c"}).json()["name"] == "c"
    assert live.http.get(f"{SETS}/{a['id']}").json()["values"] == a["values"]
    assert live.http.delete(f"{SETS}/{b['id']}").status_code == 204
    assert live.http.get(f"{SETS}/{b['id']}").status_code == 404


def test_refusals_name_what_was_wrong_and_keep_nothing(live: Any) -> None:
    bench = live.bench(paused=True)
    made = keep(live, bench, "one")
    before = live.http.get(SETS).json()
    path = f"/api/v1/benches/{bench['id']}/parameter-sets"
    taken = live.http.post(path, json={"name": "one"})
    assert taken.status_code == 409 and taken.json()["error"]["field"] == "name"
    for body in ({}, {"name": ""}, {"name": "x" * 101}, {"name": "x", "more": 1}, {"name": 3}):
        refused = live.http.post(path, json=body)
        assert refused.status_code == 422 and "\n" not in refused.json()["error"]["message"]
    assert live.http.post(f"{path}/none").status_code == 404
    for params in ({}, {"other": made["id"], "bench": bench["id"]}):
        assert live.http.get(f"{SETS}/{made['id']}/difference", params=params).status_code == 422
    assert live.http.get(f"{SETS}/{made['id']}/difference", params={"bench": "none"}).status_code == 404
    assert live.http.get(SETS).json() == before


def test_what_a_gyroscope_does_not_have_is_named_and_left_out(live: Any) -> None:
    flat = live.bench(paused=True)
    made = keep(live, flat, "of a resonator")
    gyroscope = live.bench(scenario="gyro-first-look", paused=True)
    applied = live.http.post(f"/api/v1/benches/{gyroscope['id']}/parameter-sets/{made['id']}").json()
    assert "reference.amplitude_v" in applied["left_out"] and "environment.temperature_k" not in applied["left_out"]
