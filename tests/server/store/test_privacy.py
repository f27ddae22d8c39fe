"""Readers of stored data: a data folder that a version left open to others, and the content of errors."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import text
from sqlalchemy.exc import OperationalError

from server.security.privacy import keep_private
from server.store.database import Database


@pytest.fixture(autouse=True)
def usual_umask() -> Iterator[None]:
    before = os.umask(0o022)
    yield
    os.umask(before)


def mode(path: Path) -> int:
    return path.stat().st_mode & 0o777


def test_what_is_ours_is_closed_and_what_is_not_is_left_alone(tmp_path: Path) -> None:
    data = tmp_path / "data"
    (data / "recordings").mkdir(parents=True)
    for name in ("combbench.sqlite3", "combbench.sqlite3-wal", "token", "recordings/a.parquet", "notes.txt"):
        (data / name).write_text("x")
    keep_private(data)
    assert mode(data / "combbench.sqlite3") == mode(data / "combbench.sqlite3-wal") == mode(data / "token") == 0o600
    assert mode(data / "recordings") == 0o700  # other users cannot reach its content
    assert mode(data) == 0o755 and mode(data / "notes.txt") == 0o644
    (data / "later").write_text("x")
    assert mode(data / "later") == 0o600


def test_a_folder_that_is_made_is_closed(tmp_path: Path) -> None:
    keep_private(tmp_path / "a" / "data")
    assert mode(tmp_path / "a" / "data") == mode(tmp_path / "a") == 0o700


def test_what_belongs_to_another_user_is_told_and_no_reason_not_to_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "runs").mkdir()

    def refuse(_path: Path, _mode: int) -> None:
        raise PermissionError

    monkeypatch.setattr(Path, "chmod", refuse)
    keep_private(tmp_path)
    assert f"{tmp_path / 'runs'} may be read by others" in caplog.text


def test_an_error_of_the_database_does_not_quote_what_was_to_be_stored(tmp_path: Path) -> None:
    """Such errors are logged."""
    database = Database(tmp_path / "x.sqlite3")
    with pytest.raises(OperationalError) as caught:
        database.transact(
            lambda session: session.execute(text("INSERT INTO nowhere VALUES (:name)"), {"name": "canary"})
        )
    database.close()
    assert "nowhere" in str(caught.value) and "canary" not in str(caught.value)
