"""Both databases: SQLite in a file, and PostgreSQL started from the machine's package."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.server.store.postgres import new_database, postgres


@pytest.fixture(scope="session")
def postgres_server() -> Iterator[str]:
    with postgres() as address:
        yield address


@pytest.fixture(params=["sqlite", pytest.param("postgresql", marks=pytest.mark.long)])
def place(request: pytest.FixtureRequest, tmp_path: Path) -> Any:
    """Where an empty database is: a file, or an address."""
    if request.param == "sqlite":
        return tmp_path / "new" / "test.sqlite3"
    return new_database(request.getfixturevalue("postgres_server"), "test")
