"""Benchmarks over REST: the table that comes with the version, track by track, best first."""

from __future__ import annotations

from scenarios.benchmark import results
from scenarios.benchmark.seeds import COMMITMENT
from scenarios.benchmark.track import tracks

BASE = "/api/v1/benchmarks"


def test_the_list_names_what_there_is(live):
    (card,) = live.http.get(BASE).json()["benchmarks"]
    assert card["id"] == "mems-diag-1" and card["tracks"] == [*tracks()] and card["command"] == "combbench benchmark"


def test_a_benchmark_has_every_row_in_the_order_of_its_rank(live):
    found = live.http.get(f"{BASE}/mems-diag-1").json()
    kept = results.kept()
    assert found["commitment"] == COMMITMENT and found["cases"] == 100
    assert set(found["costs"]) == {row.unit for row in kept.rows} and found["costs"]["mmae"]["over_mmae"] == 1.0
    assert sum(len(track["rows"]) for track in found["results"]) == len(kept.rows)
    for track in found["results"]:
        scored = [row["log_score"]["mean"] for row in track["rows"] if row["log_score"]]
        assert scored == sorted(scored) and len(scored) >= 10
        assert all(row["log_score"] is None for row in track["rows"][len(scored) :])
        assert all(len(row["found_within"]) in (0, len(found["within_samples"])) for row in track["rows"])
        assert track["question"].endswith("?") and track["classes"][0] == "healthy"
    assert {(one["unit"], one["track"]) for one in found["left_out"]} == {("axes_bank", name) for name in tracks()}


def test_an_unknown_benchmark_is_not_there(live):
    answer = live.http.get(f"{BASE}/mems-diag-2")
    assert answer.status_code == 404 and "mems-diag-1" in answer.json()["error"]["hint"]
