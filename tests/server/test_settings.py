"""Settings: their priority, refused values, reported values."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from core.errors import InputError
from server import settings as module
from server.settings import Settings, describe_settings, load_settings


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name in Settings.model_fields:
        monkeypatch.delenv(module.PREFIX + name.upper(), raising=False)
    return tmp_path


def source(name: str, **given: Any) -> str:
    rows = describe_settings(load_settings(**given), **given)
    return next(row.source for row in rows if row.name == name)


def test_the_command_line_wins_over_the_environment_over_the_file_over_the_default(
    here: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert load_settings().port == 8000 and source("port") == "default"
    (here / "combbench.toml").write_text("port = 1001\nmax_benches = 3\n")
    assert load_settings().port == 1001 and source("port") == "combbench.toml"
    monkeypatch.setenv("COMBBENCH_PORT", "1002")
    assert load_settings().port == 1002 and source("port") == "environment COMBBENCH_PORT"
    assert load_settings(port=1003).port == 1003 and source("port", port=1003) == "command line"
    assert load_settings(port=None).port == 1002
    assert load_settings().max_benches == 3


def test_a_wrong_file_is_refused_in_one_line(here: Path) -> None:
    for text, words in (
        ("colour = 1", ["unknown setting 'colour'", "combbench.toml"]),
        ("port = 'many'", ["'port'", "combbench.toml", "integer"]),
        ("max_benches = 0", ["'max_benches'", "greater than or equal to 1"]),
        ("port = [", ["malformed TOML", "combbench.toml"]),
        ("port = " + "[" * 5000, ["nested too deeply", "combbench.toml"]),
        ("port = '\xff'", ["not UTF-8 text", "combbench.toml"]),
    ):
        (here / "combbench.toml").write_text(text, "latin-1")
        with pytest.raises(InputError) as caught:
            load_settings()
        said = str(caught.value)
        assert all(word in said for word in words) and "\n" not in said, said


def test_a_wrong_variable_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COMBBENCH_FRAME_RATE_HZ", "-1")
    with pytest.raises(InputError, match="environment COMBBENCH_FRAME_RATE_HZ"):
        load_settings()


def test_every_setting_is_explained_and_the_token_is_not_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COMBBENCH_TOKEN", "very-secret-token-indeed")
    rows = describe_settings(load_settings())
    assert {row.name for row in rows} == set(Settings.model_fields)
    assert all(row.meaning for row in rows)
    assert not any("very-secret" in row.value for row in rows)


def test_the_password_of_the_database_is_not_shown() -> None:
    for address, shown in (
        ("postgresql://user:canary@host:1/name", "postgresql://user:***@host:1/name"),
        ("postgresql://user:p%40canary@host/name", "postgresql://user:***@host/name"),
        ("postgresql://host/name?user=user&password=canary", "postgresql://host/name?password=...&user=user"),
        ("postgresql://user:canary@host/name?sslpassword=canary", "postgresql://user:***@host/name?sslpassword=..."),
        ("postgresql://user:canary@host:port/name", "***"),
        ("canary", "***"),
        ("postgresql://user@host/name", "postgresql://user@host/name"),
        ("", ""),
    ):
        settings = load_settings(database_url=address)
        rows = {row.name: row.value for row in describe_settings(settings)}
        assert rows["database_url"] == shown and "canary" not in repr(settings)


def test_what_is_loopback() -> None:
    near, far = ("127.0.0.1", "127.1.2.3", "localhost", "::1"), ("0.0.0.0", "::", "10.0.0.1", "example")
    assert [Settings(host=host).is_loopback for host in (*near, *far)] == [True] * 4 + [False] * 4
