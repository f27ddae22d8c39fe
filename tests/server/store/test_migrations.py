"""The database is migrated to this version, and its tables equal the tables of the models; SQLite and PostgreSQL
alike."""

from __future__ import annotations

import asyncio
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from alembic import command
from sqlalchemy import MetaData, inspect, text

from core.errors import InputError
from server.store.base import Base
from server.store.database import Database, alembic_config, make_engine
from server.store.models import RecordingRow, RequestRow, ResultRow
from tests.server.store.postgres import new_database


def test_the_migrations_lead_to_the_models(place: Any) -> None:
    database = Database(place)
    database.migrate()
    database.migrate()  # nothing left to do
    command.check(alembic_config(database.url))
    engine = make_engine(database.url)
    assert set(inspect(engine).get_table_names()) == {*Base.metadata.tables, "alembic_version"}
    with engine.connect() as connection:
        if engine.dialect.name == "sqlite":
            assert connection.exec_driver_sql("PRAGMA journal_mode").scalar() == "wal"
        else:
            assert connection.exec_driver_sql("SHOW server_version_num").scalar() >= "130000"
    engine.dispose()
    database.close()


def test_the_migrations_lead_back(place: Any) -> None:
    database = Database(place)
    database.migrate()
    command.downgrade(alembic_config(database.url), "base")
    engine = make_engine(database.url)
    assert inspect(engine).get_table_names() == ["alembic_version"]
    engine.dispose()
    database.migrate()  # and forth again
    database.close()


def test_rows_of_the_first_version_are_carried_along(place: Any) -> None:
    database = Database(place)
    command.upgrade(alembic_config(database.url), "0001")
    row = (
        "INSERT INTO recordings (id, bench_id, name, state, title, dt_ms, start_tick, ticks, signals, created, reason) "
        "VALUES ('a', 'b', 'old', 'done', 'Old', 0.01, 5, 7, '[]', '2020-01-01 00:00:00', '')"
    )
    database.transact(lambda session: session.execute(text(row)))
    command.upgrade(alembic_config(database.url), "0002")
    campaign = (
        "INSERT INTO sweeps (id, state, name, title, document, version, runs, created) "
        "VALUES ('s', 'done', 'mine', 'Mine', '{}', 'v', 200, '2020-01-01 00:00:00')"
    )
    database.transact(lambda session: session.execute(text(campaign)))
    database.migrate()
    found = database.transact(lambda session: session.get(RecordingRow, "a"))
    assert (found.name, found.start_tick, found.ticks, found.bytes, found.scenario) == ("old", 5, 7, 0, None)
    assert database.transact(lambda session: session.get(RequestRow, "s").done) == 200
    # ticks of a long recording do not fit into 32 bits
    database.transact(lambda session: setattr(session.get(RecordingRow, "a"), "ticks", 2**40))
    assert database.transact(lambda session: session.get(RecordingRow, "a").ticks) == 2**40
    database.close()


SUMMARY = {
    "scenario": "first-look",
    "title": "First look",
    "source": "",
    "claim": "",
    "verdict": None,
    "seed": 3,
    "ticks": 5,
    "dt_s": 1e-5,
    "elapsed_s": 0.1,
    "digest": "d",
    "trip": None,
    "warnings": [],
    "metrics": {"m": 1.5},
    "expectations": [],
    "ok": True,
}
OLD = {
    "runs": {
        "ended": {
            "state": "done",
            "label": "mine",
            "seeds": [3, 4, 5],
            "summary": SUMMARY,
        },
        "failed": {"state": "failed", "seeds": [1], "error": {"code": "invalid", "message": "no"}, "attempts": 1},
        "begun": {"state": "running", "seeds": [1, 2], "progress": 0.4, "attempts": 2, "finished": None},
    },
    "sweeps": {
        "named": {"state": "done", "label": "study", "document": {"scenario": "first-look"}, "runs": 20, "done": 20},
        "whole": {"state": "cancelled", "document": {"scenario": {"id": "own", "samples": 5}}, "runs": 9, "done": 4},
    },
}
"""Rows as the code of the sixth version wrote them, but for what all of them have."""


def as_it_was(database: Database, tables: tuple[str, ...] = ("runs", "sweeps")) -> dict[str, list[dict[str, Any]]]:
    """Return the rows of the tables of the sixth version."""
    engine = make_engine(database.url)
    metadata = MetaData()
    metadata.reflect(engine, only=tables)
    with engine.connect() as connection:
        found = {
            name: [dict(row) for row in connection.execute(metadata.tables[name].select().order_by("id")).mappings()]
            for name in tables
        }
    engine.dispose()
    return found


def put_old_rows(database: Database) -> None:
    """Make the tables of the sixth version with some rows."""
    command.upgrade(alembic_config(database.url), "0006")
    engine = make_engine(database.url)
    metadata = MetaData()
    metadata.reflect(engine)
    moment = datetime(2026, 3, 4, 5, 6, 7, 89, UTC)
    with engine.begin() as connection:
        for name, given in (pair for rows in OLD.values() for pair in rows.items()):
            is_run = name in OLD["runs"]
            run = {"key": f"{name}-key", "scenario_id": "first-look", "progress": 1.0, "attempts": 0, "summary": None}
            sweep = {"name": f"{name}-name", "version": "old"}
            shared = {"id": name, "title": "A title", "label": "", "document": {"id": "first-look"}, "created": moment}
            row = {**shared, "finished": moment, "error": None, **(run if is_run else sweep), **given}
            connection.execute(metadata.tables["runs" if is_run else "sweeps"].insert(), row)
        outcome = {"key": "k" * 64, "outcome": {"seed": 1}, "created": moment}
        connection.execute(metadata.tables["results"].insert(), outcome)
    engine.dispose()


def test_runs_and_campaigns_come_into_one_table_and_lead_back(place: Any) -> None:
    database = Database(place)
    put_old_rows(database)
    before = as_it_was(database)
    database.migrate()
    rows = database.transact(lambda session: {row.id: row for row in session.query(RequestRow)})
    assert set(rows) == {*OLD["runs"], *OLD["sweeps"]}
    run, begun, named, whole = (rows[name] for name in ("ended", "begun", "named", "whole"))
    assert (run.kind, run.key, run.name, run.scenario_id) == ("run", "ended-key", "first-look", "first-look")
    assert (run.seeds, run.runs, run.done, run.label) == ([3, 4, 5], 3, 3, "mine")
    assert run.summary == OLD["runs"]["ended"]["summary"] and run.document == {"id": "first-look"}
    assert run.created == run.finished == datetime(2026, 3, 4, 5, 6, 7, 89, UTC)
    assert (begun.state, begun.attempts, begun.done, begun.finished) == ("running", 2, 0, None)
    assert rows["failed"].error == OLD["runs"]["failed"]["error"]
    assert (named.kind, named.name, named.scenario_id, named.version) == ("campaign", "named-name", "first-look", "old")
    assert (named.runs, named.done, named.label, named.seeds) == (20, 20, "study", None)
    assert (whole.scenario_id, whole.done, whole.document["scenario"]["samples"]) == ("own", 4, 5)
    assert database.transact(lambda session: session.get(ResultRow, "k" * 64).outcome) == {"seed": 1}
    command.downgrade(alembic_config(database.url), "0006")
    after = as_it_was(database)
    for row in before["runs"]:
        row["progress"] = 1.0 if row["state"] == "done" else 0.0  # of an unfinished run nothing is kept
    assert after == before
    database.close()


@pytest.mark.parametrize("kind", ["sqlite", pytest.param("postgresql", marks=pytest.mark.long)])
def test_a_data_folder_of_the_sixth_version_opens(
    kind: str, request: pytest.FixtureRequest, serve: Any, tmp_path: Path
) -> None:
    """Runs, campaigns, names and files exist; interrupted work is reported."""
    at: dict[str, Any] = {}
    if kind == "postgresql":
        at = {"database_url": new_database(request.getfixturevalue("postgres_server"), "folder")}
    database = Database(at.get("database_url", tmp_path / "combbench.sqlite3"))
    put_old_rows(database)
    database.close()
    (tmp_path / "runs" / "ended").mkdir(parents=True)
    (tmp_path / "runs" / "ended" / "run.html").write_text("<p>as it was</p>")
    with serve(folder=tmp_path, **at) as live:
        runs = {one["id"]: one for one in live.http.get("/api/v1/runs").json()["runs"]}
        assert set(runs) == set(OLD["runs"])
        done = live.http.get("/api/v1/runs/ended").json()
        assert done == runs["ended"] and done["label"] == "mine" and done["progress"] == 1.0
        assert done["summary"]["metrics"] == {"m": 1.5} and done["seeds"] == [3, 4, 5]
        assert live.http.get("/api/v1/runs/ended/report").text == "<p>as it was</p>"
        begun = live.http.get("/api/v1/runs/begun").json()
        assert begun["state"] == "aborted" and "another version" in begun["error"]["message"]
        sweeps = {one["id"]: one for one in live.http.get("/api/v1/sweeps").json()["sweeps"]}
        assert {key: (one["label"], one["done"], one["runs"]) for key, one in sweeps.items()} == {
            "named": ("study", 20, 20),
            "whole": ("", 4, 9),
        }
        found = live.http.get("/api/v1/sweeps?scenario=own").json()["sweeps"]
        assert [one["id"] for one in found] == ["whole"]
        assert live.http.get("/api/v1/sweeps/named/points").status_code == 409  # of another version, as before
        assert live.http.post("/api/v1/runs/remove", json={}).json() == {"removed": 3}
        assert not (tmp_path / "runs" / "ended").exists()
        assert len(live.http.get("/api/v1/sweeps").json()["sweeps"]) == 2


def test_it_says_whether_it_can_be_written(tmp_path: Path) -> None:
    database = Database(tmp_path / "test.sqlite3")
    database.migrate()
    assert asyncio.run(database.is_writable())
    assert asyncio.run(database.is_writable())
    blocker = make_engine(database.url)
    with blocker.connect() as connection:
        connection.exec_driver_sql("BEGIN EXCLUSIVE")
        assert not asyncio.run(database.is_writable())
    blocker.dispose()
    database.close()


@pytest.mark.long
def test_it_says_whether_postgresql_can_be_written(postgres_server: str) -> None:
    database = Database(postgres_server + "/postgres")
    assert asyncio.run(database.is_writable())
    database.close()
    gone = Database("postgresql://bench@127.0.0.1:1/test")
    assert not asyncio.run(gone.is_writable())
    gone.close()


def test_another_database_is_refused() -> None:
    for address in ("mysql://a@b/c", "nonsense"):
        with pytest.raises(InputError, match="database"):
            Database(address)
