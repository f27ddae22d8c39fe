"""The list of runs: names, filters, comparison, removal; by the interface, refusals in the shared shape."""

from __future__ import annotations

import math
from typing import Any

import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.server.runs.test_large_campaign import ended
from tests.server.runs.test_runs import long_run, wait

RUNS = "/api/v1/runs"
SWEEP = {"schema": 1, "id": "few", "scenario": "ch5-seven-step", "set": {"samples": 600}, "seeds": {"count": 2}}


def start(live: Any, seed: int = 1, samples: int = 700, **more: Any) -> dict[str, Any]:
    body = {"scenario": "ch5-seven-step", "set": {"samples": samples}, "seed": seed, **more}
    return wait(live, live.http.post(RUNS, json=body).json()["id"])


def ids(live: Any, query: str) -> list[str]:
    return [one["id"] for one in live.http.get(f"{RUNS}?{query}").json()["runs"]]


def refused(answer: Any, status: int, code: str) -> str:
    assert answer.status_code == status, answer.text
    error = answer.json()["error"]
    assert error["code"] == code and "\n" not in error["message"]
    return f"{error['field']}: {error['message']}"


def test_runs_have_names_and_are_found_by_them(live: Any) -> None:
    plain, named = start(live, 31), start(live, 32, label="  first \n try, 5 % ")
    assert plain["label"] == "" and named["label"] == "first try, 5 %"
    assert ids(live, "text=TRY first") == [named["id"]]
    # other tests' runs may have "5 %" in their titles
    assert ids(live, "text=try, 5 %25") == [named["id"]] and ids(live, "text=try, 5_%25") == []
    assert {plain["id"], named["id"]} <= set(ids(live, "text=seven-step&state=done&scenario=ch5-seven-step"))
    assert plain["id"] not in ids(live, "state=failed") and plain["id"] not in ids(live, "scenario=first-look")
    again = live.http.patch(f"{RUNS}/{plain['id']}", json={"label": "second try"})
    assert again.json()["label"] == "second try" and ids(live, "text=second try") == [plain["id"]]
    # asked for again under another name it is the same run, and has that name
    assert start(live, 32, label="third")["label"] == "third" and start(live, 32)["label"] == "third"
    assert live.http.patch(f"{RUNS}/{plain['id']}", json={"label": ""}).json()["label"] == ""
    assert "state" in refused(live.http.get(f"{RUNS}?state=gone"), 422, "invalid")
    assert "label" in refused(live.http.patch(f"{RUNS}/{plain['id']}", json={"label": "x" * 121}), 422, "invalid")
    refused(live.http.patch(f"{RUNS}/none", json={"label": "x"}), 404, "not_found")
    before = len(ids(live, ""))
    body = {"scenario": "ch5-seven-step", "seed": 99, "label": "y" * 200}
    assert "label" in refused(live.http.post(RUNS, json=body), 422, "invalid")
    assert len(ids(live, "")) == before


def test_finished_runs_are_compared_figure_by_figure_and_trace_over_trace(live: Any) -> None:
    first, second = start(live, 41), start(live, 42, 900)
    found = live.http.get(f"{RUNS}/compare", params={"ids": [first["id"], second["id"]]}).json()
    assert [one["id"] for one in found["runs"]] == [first["id"], second["id"]]
    rows = {row["metric"]: row for row in found["figures"]}
    expected = [run(with_values(get("ch5-seven-step"), {"samples": n}), s).metrics for n, s in ((700, 41), (900, 42))]
    for name in expected[0].keys() & expected[1].keys():
        values = [one[name] for one in expected]
        assert rows[name]["values"] == pytest.approx(values)
        assert rows[name]["differences"] == pytest.approx([0.0, values[1] - values[0]])
    units = {one["name"]: one["unit"] for one in found["signals"]}
    assert units["plant.displacement"] == "um" and units["drive.voltage"] == "V"
    query = {"ids": [first["id"], second["id"]], "signal": "plant.displacement", "columns": 50}
    traces = live.http.get(f"{RUNS}/compare/trace", params=query).json()
    assert traces["unit"] == "um"
    for one, samples, seed in zip(traces["runs"], (700, 900), (41, 42), strict=True):
        whole = run(with_values(get("ch5-seven-step"), {"samples": samples}), seed).signal("plant.displacement")
        assert len(one["values"]) <= 100 and math.isclose(max(one["values"]), float(whole.max()))
    answer = live.http.get(f"{RUNS}/compare/trace", params={**query, "signal": "nonsense"})
    assert "signal" in refused(answer, 422, "unknown")
    refused(live.http.get(f"{RUNS}/compare", params={"ids": [first["id"], "none"]}), 404, "not_found")
    refused(live.http.get(f"{RUNS}/compare", params={"ids": [first["id"], first["id"]]}), 422, "invalid")
    refused(live.http.get(f"{RUNS}/compare", params={"ids": [first["id"]]}), 422, "invalid")


def test_a_figure_that_one_run_lacks_has_no_difference(live: Any) -> None:
    first = start(live, 51)
    study = wait(live, live.http.post(RUNS, json={"scenario": "ch1-beam-width"}).json()["id"])
    found = live.http.get(f"{RUNS}/compare", params={"ids": [first["id"], study["id"]]}).json()
    rows = {row["metric"]: row for row in found["figures"]}
    assert rows["beam_width.softer_1_um_pct"]["values"][0] is None
    assert rows["beam_width.softer_1_um_pct"]["differences"] == [None, None]
    assert found["signals"] == []


def test_runs_that_have_ended_are_removed_with_their_files(serve: Any) -> None:
    with serve() as live:
        runs = [start(live, seed) for seed in (1, 2, 3)]
        folders = {one["id"]: live.service.settings.data / "runs" / one["id"] for one in runs}
        assert all(folder.is_dir() for folder in folders.values())
        active = live.http.post(RUNS, json=long_run()).json()["id"]
        refused(live.http.post(f"{RUNS}/remove", json={"ids": [runs[0]["id"], active]}), 409, "conflict")
        refused(live.http.post(f"{RUNS}/remove", json={"ids": [runs[0]["id"], "none"]}), 404, "not_found")
        assert set(ids(live, "")) == {active, *folders}  # nothing was removed
        assert live.http.post(f"{RUNS}/remove", json={"ids": [runs[0]["id"]]}).json() == {"removed": 1}
        assert not folders[runs[0]["id"]].exists() and runs[0]["id"] not in ids(live, "")
        assert live.http.post(f"{RUNS}/remove", json={}).json() == {"removed": 2}
        assert ids(live, "") == [active] and not any(folder.exists() for folder in folders.values())
        live.http.delete(f"{RUNS}/{active}")
        assert start(live, 1)["summary"]["digest"] == runs[0]["summary"]["digest"]  # it may be asked for again


def test_campaigns_have_names_and_are_removed(live: Any) -> None:
    found = live.http.post("/api/v1/sweeps", json={"sweep": SWEEP, "label": "noise study"}).json()
    assert found["label"] == "noise study"
    sweeps = "/api/v1/sweeps"
    for query, is_there in (("text=noise", True), ("text=other", False), ("scenario=ch5-seven-step", True)):
        listed = [one["id"] for one in live.http.get(f"{sweeps}?{query}").json()["sweeps"]]
        assert (found["id"] in listed) == is_there
    assert ended(live, found["id"])["state"] == "done"
    assert live.http.patch(f"{sweeps}/{found['id']}", json={"label": "renamed"}).json()["label"] == "renamed"
    assert live.http.post(f"{sweeps}/remove", json={"ids": [found["id"]]}).json() == {"removed": 1}
    refused(live.http.get(f"{sweeps}/{found['id']}"), 404, "not_found")
