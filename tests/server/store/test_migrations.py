"""The database is brought to this version, and its tables are those of the models."""

from __future__ import annotations

import asyncio
from pathlib import Path

from alembic import command
from sqlalchemy import inspect

from server.store.database import Database, alembic_config, make_engine
from server.store.models import Base


def test_the_migrations_lead_to_the_models(tmp_path: Path) -> None:
    database = Database(tmp_path / "new" / "test.sqlite3")
    database.migrate()
    database.migrate()  # nothing left to do
    command.check(alembic_config(database.url))
    engine = make_engine(database.url)
    assert set(inspect(engine).get_table_names()) == {*Base.metadata.tables, "alembic_version"}
    with engine.connect() as connection:
        assert connection.exec_driver_sql("PRAGMA journal_mode").scalar() == "wal"
    engine.dispose()
    database.close()


def test_the_migrations_lead_back(tmp_path: Path) -> None:
    database = Database(tmp_path / "test.sqlite3")
    database.migrate()
    command.downgrade(alembic_config(database.url), "base")
    engine = make_engine(database.url)
    assert inspect(engine).get_table_names() == ["alembic_version"]
    engine.dispose()
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
