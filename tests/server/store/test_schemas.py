"""A data folder of each earlier schema opens, with all that was in it.

A file of `schemas` is the database as its revision made it, with a row or two for each table: a class of one student on
Tuesday who votes, answers, plays and works at a sheet; a recording, a run, a campaign, a set of parameters, a link.
"""

from __future__ import annotations

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from core.errors import InputError
from server.settings import Settings
from server.store.database import FILE, MIGRATIONS, check_left_behind
from tests.server.store.test_kept import KEPT, WHOLE

SCHEMAS = Path(__file__).with_name("schemas")
REVISIONS = sorted(path.stem[:4] for path in (MIGRATIONS / "versions").glob("[0-9]*.py"))
SECRET = "s-yd5iPqLmftPuE-NPb2sbwwmlMro421zgXQAqmsgrA"
"""Of the student's session."""


def put(revision: str, folder: Path) -> Path:
    """Make a data folder of a revision."""
    with closing(sqlite3.connect(folder / FILE)) as connection:
        connection.executescript((SCHEMAS / f"{revision}.sql").read_text("utf-8"))
    (folder / "recordings").mkdir()
    shutil.copy(KEPT / "recordings" / f"{WHOLE}.parquet", folder / "recordings")
    return folder / FILE


def test_each_revision_has_its_folder() -> None:
    assert [path.stem for path in sorted(SCHEMAS.glob("*.sql"))] == REVISIONS


@pytest.mark.parametrize("revision", REVISIONS)
def test_a_data_folder_opens(revision: str, serve: Any, tmp_path: Path) -> None:
    put(revision, tmp_path)
    with serve(folder=tmp_path) as live:

        def found(path: str, **headers: str) -> Any:
            answer = live.http.get(f"/api/v1/{path}", headers=headers)
            assert answer.status_code == 200, (path, answer.text)
            return answer.json()

        (run,) = found("runs")["runs"]
        assert (run["state"], run["scenario_id"], run["summary"]["ticks"]) == ("done", "kept-live", 191)
        text = live.http.get(f"/api/v1/runs/{run['id']}/scenario").text
        assert text.startswith("#:schema ./scenario.schema.json\nschema = 1\n"), text[:100]
        (recording,) = found("recordings")["recordings"]
        assert (recording["id"], recording["state"], recording["ticks"]) == (WHOLE, "done", 181)
        assert len(recording["signals"]) == 3
        assert live.http.get(f"/api/v1/recordings/{WHOLE}/trace").status_code == 200
        if revision >= "0002":
            (campaign,) = found("sweeps")["sweeps"]
            assert (campaign["state"], campaign["done"], campaign["runs"]) == ("done", 3, 3)
            assert campaign["label"] == ("three seeds" if revision >= "0006" else "")
        if revision >= "0004":
            (kept,) = found("parameter-sets")["sets"]
            assert kept["name"] == "stiff"
        if revision >= "0005":
            (link,) = found("links")["links"]
            assert link["title"] == "two scopes"
        if revision < "0008":
            return
        (group,) = found("classes")["classes"]
        assert (group["name"], group["students"]) == ("Tuesday", 1)
        me = found("me", Authorization=f"Bearer {SECRET}")
        assert (me["role"], me["name"], me["class_id"]) == ("student", "Ada", group["id"])
        assert live.http.post(f"/api/v1/classes/{group['id']}/code", json={}).json()["code"]
        if revision >= "0012":
            (answer,) = found(f"classes/{group['id']}/blind")["answers"]
            assert (answer["name"], answer["state"], answer["confidence"]) == ("Ada", "answered", 0.5)
        if revision >= "0013":
            (own,) = (sheet for sheet in found("sheets")["sheets"] if sheet["own"])
            assert own["title"] == "My first look: a resonator and who watches it"
            (grade,) = found(f"classes/{group['id']}/grades?format=json")["grades"]
            assert grade["sheet"] == own["id"]
        if revision >= "0014":
            (vote,) = found("votes")["votes"]
            assert (vote["class_id"], vote["voted"]) == (group["id"], 1)
        if revision >= "0018":
            (line,) = found(f"classes/{group['id']}/games/be-the-filter?seed=7")["table"]
            assert line["name"] == "Ada"
        if revision >= "0020":
            (record,) = found("records")["records"]
            assert (record["name"], record["samples"]) == ("device.csv", 2000)
            (device,) = found("measured-devices")["devices"]
            assert (device["name"], device["values"]) == ("device of Tuesday", {"device.mass_kg": 2.3e-10})
        texts = [entry["text"] for entry in found(f"classes/{group['id']}/audit")["entries"]]
        assert "opened the class Tuesday" in texts


def test_classes_of_a_process_with_a_letter_are_not_left_out(serve: Any, tmp_path: Path) -> None:
    """Once such a process kept its classes in a SQLite of its own, beside the database that it shared."""
    file = put("0018", tmp_path)
    check_left_behind(file)
    check_left_behind(tmp_path / "nothing")
    with closing(sqlite3.connect(file)) as connection, connection:
        connection.execute("UPDATE people SET bench_id = 'b' || bench_id")
        connection.execute("UPDATE recordings SET bench_id = 'b' || bench_id")
    with pytest.raises(InputError, match="a process with a letter") as refused:
        check_left_behind(file)
    assert refused.value.field == "database_url" and "\n" not in str(refused.value)
    with serve(folder=tmp_path) as live:  # alone it opens
        assert live.http.get("/api/v1/classes").json()["classes"][0]["students"] == 1
        assert live.http.get("/api/v1/sweeps").json()["sweeps"][0]["done"] == 3


def test_there_is_no_letter_any_more(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from server.settings import load_settings

    monkeypatch.chdir(tmp_path)
    (tmp_path / "combbench.toml").write_text('shard = "b"\n')
    with pytest.raises(InputError, match="unknown setting 'shard'"):
        load_settings()
    assert "shard" not in Settings.model_fields
