"""The gallery by the interface: claims beside figures, drawings, reports, and scripts that repeat a run."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from scenarios.library import get, library
from scenarios.run import run
from tests.server.conftest import TOKEN
from tests.server.runs.test_runs import wait


def cards(live: Any) -> dict[str, dict[str, Any]]:
    return {card["id"]: card for card in live.http.get("/api/v1/gallery").json()["cards"]}


def test_a_card_has_its_claim_before_its_run_and_its_figures_after(serve: Any) -> None:
    with serve() as live:  # where nothing has been run
        before = cards(live)
        assert list(before) == [scenario.id for scenario in library()]
        listed = live.http.get("/api/v1/scenarios").json()["scenarios"]
        assert {entry["id"]: entry["study"] for entry in listed} == {
            name: card["study"] for name, card in before.items()
        }
        chosen = before["ch1-beam-width"]
        assert chosen["claim"] == get("ch1-beam-width").head.claim and chosen["study"] == "beam_width"
        assert chosen["state"] == "new" and chosen["ok"] is None and chosen["run"] is None
        assert chosen["expectations"] and all(one["ok"] is None for one in chosen["expectations"])
        answer = live.http.post("/api/v1/gallery/run", json={"only": "ch[15]-[bs]e*"})  # beam-width and seven-step
        assert answer.status_code == 202
        asked = [card for card in answer.json()["cards"] if card["state"] != "new"]
        assert {card["id"] for card in asked} >= {"ch1-beam-width", "ch5-seven-step"}
        for card in asked:
            wait(live, card["run"])
        after = cards(live)
        for name in ("ch1-beam-width", "ch5-seven-step"):
            card, expected = after[name], run(get(name))
            assert card["state"] == "done" and card["progress"] == 1.0 and card["ok"] is True
            assert card["digest"] == expected.digest
            assert [one["measured"] for one in card["expectations"]] == [
                one["measured"] for one in expected.expectations()
            ]
            drawing = live.http.get(f"/api/v1/runs/{card['run']}/thumbnail")
            assert drawing.headers["content-type"].startswith("image/svg+xml")
            assert ElementTree.fromstring(drawing.text).attrib["aria-label"] == get(name).head.title
            report = live.http.get(f"/api/v1/runs/{card['run']}/report")
            assert report.headers["content-type"].startswith("text/html") and expected.digest in report.text
            assert "default-src 'none'" in report.headers["content-security-policy"]
        again = live.http.post("/api/v1/gallery/run", json={"only": "ch5-seven-step"}).json()["cards"]
        assert next(card for card in again if card["id"] == "ch5-seven-step")["state"] == "done"
        assert live.http.post("/api/v1/gallery/run", json={"only": "zz*"}).status_code == 422
        assert live.http.get("/api/v1/runs/none/thumbnail").status_code == 404


def execute(live: Any, path: Path, text: str) -> subprocess.CompletedProcess[str]:
    path.write_text(text)
    environment = {**os.environ, "COMBBENCH_TOKEN": TOKEN}
    command = [sys.executable, "-S", str(path), live.address]
    return subprocess.run(command, cwd=path.parent, env=environment, capture_output=True, text=True, timeout=120)


def test_the_script_of_a_run_repeats_it(live: Any, tmp_path: Path) -> None:
    body = {"scenario": "ch5-seven-step", "set": {"samples": 1200}, "seeds": "4:5"}
    found = wait(live, live.http.post("/api/v1/runs", json=body).json()["id"])
    answer = live.http.get(f"/api/v1/runs/{found['id']}/script")
    assert 'filename="ch5-seven-step.py"' in answer.headers["content-disposition"]
    path = tmp_path / "again.py"
    done = execute(live, path, answer.text)
    assert done.returncode == 0, done.stderr
    assert f"digest {found['summary']['digest']}" in done.stdout
    assert len((tmp_path / "again.csv").read_text().splitlines()) == 1201
    # the run is the same one, not a second
    assert [one["id"] for one in live.http.get("/api/v1/runs").json()["runs"]].count(found["id"]) == 1
    other = execute(live, path, answer.text.replace(found["summary"]["digest"], "0" * 64))
    assert other.returncode == 1 and "other bits" in other.stderr


def test_the_script_of_a_campaign_repeats_it(live: Any, tmp_path: Path) -> None:
    sweep = {
        "schema": 1,
        "id": "again",
        "scenario": "ch5-seven-step",
        "set": {"samples": 1200},
        "seeds": "3:4",
        "grid": {"sensor.noise_um": [0.05, 0.1]},
    }
    found = live.http.post("/api/v1/sweeps", json={"sweep": sweep}).json()
    answer = live.http.get(f"/api/v1/sweeps/{found['id']}/script")
    assert 'filename="again.py"' in answer.headers["content-disposition"]
    done = execute(live, tmp_path / "again.py", answer.text)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("of 2 runs as expected") == 2
    rows = (tmp_path / "again.csv").read_text().splitlines()
    assert len(rows) == 5 and "sensor.noise_um" in rows[0]
    assert "<h2>Points</h2>" in (tmp_path / "again.html").read_text()
    # it is the same campaign, not a second
    assert [one["id"] for one in live.http.get("/api/v1/sweeps").json()["sweeps"]].count(found["id"]) == 1
