"""The database is brought to this version, and its tables are those of the models; SQLite and PostgreSQL alike."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import pytest
from alembic import command
from sqlalchemy import inspect, text

from server.store.database import Database, alembic_config, make_engine
from server.store.models import Base, RecordingRow, RequestRow


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


def test_it_says_whether_postgresql_can_be_written(postgres_server: str) -> None:
    database = Database(postgres_server + "/postgres")
    assert asyncio.run(database.is_writable())
    database.close()
    gone = Database("postgresql://bench@127.0.0.1:1/test")
    assert not asyncio.run(gone.is_writable())
    gone.close()


@pytest.mark.parametrize("address", ["mysql://a@b/c", "nonsense"])
def test_another_database_is_refused(address: str) -> None:
    from core.errors import InputError

    with pytest.raises(InputError, match="database"):
        Database(address)
