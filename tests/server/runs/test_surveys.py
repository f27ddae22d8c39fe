"""Results of campaigns over REST: page by page, as distributions, from files that are made anew when they are lost."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pyarrow.csv
import pyarrow.parquet as pq
import pytest

from scenarios.campaign import parquet
from tests.server.runs.test_large_campaign import ended
from tests.server.test_bad_input import check

NOISES = [0.05, 0.2, 0.1]
CAMPAIGN: dict[str, Any] = {
    "schema": 1,
    "id": "paged",
    "scenario": "ch5-seven-step",
    "set": {"samples": 2500},
    "seeds": {"count": 4},
    "grid": {"sensor.noise_um": NOISES},
}
NAME = "diagnosis.kalman.nis"


def labels(answer: dict[str, Any]) -> list[float]:
    return [point["labels"]["sensor.noise_um"] for point in answer["points"]]


def test_a_campaign_is_read_from_its_files(serve: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(parquet, "PART", 5)
    for name in ("scenarios.campaign.survey", "server.runs.surveys"):
        monkeypatch.setattr(f"{name}.PART", 5)
    with serve() as live:
        found = ended(live, live.http.post("/api/v1/sweeps", json={"sweep": CAMPAIGN}).json()["id"])
        path, folder = f"/api/v1/sweeps/{found['id']}", tmp_path / "sweeps" / found["id"]

        def get(rest: str) -> dict[str, Any]:
            return dict(live.http.get(f"{path}/{rest}").json())

        everything = get("points")
        assert labels(everything) == NOISES and everything["found"] == 3
        assert "sensor.noise_um" in everything["quantities"] and NAME in everything["figures"]
        frame = pq.read_table(folder)
        rows = frame.group_by("sensor.noise_um").aggregate([(NAME, "mean")]).to_pylist()
        means = {row["sensor.noise_um"]: row[f"{NAME}_mean"] for row in rows}
        assert len(frame) == 12 and len(list(folder.iterdir())) == 3
        for point in everything["points"]:
            assert point["metrics"][NAME]["mean"] == pytest.approx(means[point["labels"]["sensor.noise_um"]])

        page = get("points?limit=2&offset=1")
        assert labels(page) == NOISES[1:] and page["found"] == 3
        assert labels(get("points?limit=3&sort=sensor.noise_um&descending=true")) == [0.2, 0.1, 0.05]
        assert labels(get(f"points?limit=1&sort={NAME}")) == [min(means, key=means.__getitem__)]
        assert get("points?offset=9")["points"] == []

        spread = get(f"distribution?x=sensor.noise_um&y={NAME}")
        assert spread["runs"] == 12 == sum(map(sum, spread["counts"])) and len(spread["dots"]) == 12
        assert sum(get("distribution?x=seed")["counts"][0]) == 12

        check(live.http.get(f"{path}/points?sort=nis"), 422, None, "nis")
        assert get("points?limit=5000")["points"] == everything["points"] and everything["runs"] == 12
        check(live.http.get(f"{path}/points?limit=20001"), 422, None, "20000")
        check(live.http.get(f"{path}/distribution?x=variant"), 422, None, "variant")
        check(live.http.get(f"{path}/distribution"), 422, None)

        answer = live.http.get(f"{path}/runs")
        assert (answer.headers["X-Runs"], answer.headers["X-State"]) == ("12", "done")
        assert "so-far" not in answer.headers["Content-Disposition"]
        table = pyarrow.csv.read_csv(io.BytesIO(answer.content))
        assert table.column_names[0] == "key" and table["key"].to_pylist() == frame["key"].to_pylist()
        assert not any(name.endswith(".confusion") for name in table.column_names)

        # a file that is lost is made anew from the table of results
        (folder / "part-00001.parquet").unlink()
        assert get("points")["points"] == everything["points"]
        assert pq.read_table(folder).equals(frame)

        live.http.post("/api/v1/sweeps/remove", json={"ids": [found["id"]]})
        assert not folder.exists()


def test_files_grow_while_a_campaign_runs(serve: Any, tmp_path: Path) -> None:
    """Requests during the run are read from files that hold the finished runs."""
    long = {**CAMPAIGN, "set": {"samples": 9000}, "seeds": {"count": 300}}
    with serve() as live:
        sweep_id = live.http.post("/api/v1/sweeps", json={"sweep": long}).json()["id"]
        path = f"/api/v1/sweeps/{sweep_id}"
        while not (answer := live.http.get(f"{path}/points?limit=5").json())["found"]:
            pass
        assert answer["sweep"]["state"] == "running" and 0 < answer["points"][0]["runs"] <= answer["sweep"]["done"]
        part = live.http.get(f"{path}/runs")
        assert (part.headers["X-State"], part.headers["X-Runs"]) == ("running", str(part.text.count("\n") - 1))
        assert 'runs-so-far.csv"' in part.headers["Content-Disposition"]
        live.http.delete(path)
        found = ended(live, sweep_id)
        answer = live.http.get(f"{path}/points").json()
        assert sum(point["runs"] for point in answer["points"]) == found["done"] < 900
        assert len(pq.read_table(tmp_path / "sweeps" / sweep_id)) == found["done"]


def test_results_that_end_while_they_are_read_are_read_again(serve: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """An answer that says the campaign is done has all of its runs."""
    with serve() as live:
        sweeps = live.service.sweeps
        sweep_id = live.http.post("/api/v1/sweeps", json={"sweep": CAMPAIGN}).json()["id"]
        ended(live, sweep_id)
        running, read = True, sweeps.read
        get = sweeps.get

        async def get_late(asked: str) -> Any:
            found = await get(asked)
            return found.model_copy(update={"state": "running", "finished": None}) if running else found

        async def read_early(asked: str, reader: Any) -> Any:
            nonlocal running
            found = await read(asked, reader)
            if not running:
                return found
            running = False  # it ends now
            return {**found, "points": [], "runs": 0}

        monkeypatch.setattr(sweeps, "get", get_late)
        monkeypatch.setattr(sweeps, "read", read_early)
        answer = live.http.get(f"/api/v1/sweeps/{sweep_id}/points").json()
        assert (answer["sweep"]["state"], answer["runs"], len(answer["points"])) == ("done", 12, 3)
