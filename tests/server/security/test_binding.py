"""Other machines are admitted only with a token that a user chose."""

from __future__ import annotations

from pathlib import Path

import pytest

from core.errors import InputError
from server.cli.serve import bind, check_binding
from server.security.identity import Identity, token_of
from server.settings import Settings

TOKEN = "sixteen-characters-or-more"


ALLOWED = [("127.0.0.1", None), ("127.0.0.7", None), ("localhost", None), ("::1", None), ("127.0.0.1", TOKEN)]
ALLOWED += [("0.0.0.0", TOKEN), ("192.168.1.5", TOKEN), ("127.0.0.1", "aaaaaaaaaaaaaaaa&b+c#d%41 e")]
REFUSED = [("0.0.0.0", None), ("::", None), ("192.168.1.5", None), ("bench.example", None), ("0.0.0.0", "")]
REFUSED += [("0.0.0.0", "short"), ("127.0.0.1", "short"), ("127.0.0.1", "caf\u00e9-caf\u00e9-caf\u00e9-caf\u00e9")]
REFUSED += [("127.0.0.1", "aaaaaaaaaaaaaaaa\r\nb: c"), ("127.0.0.1", "aaaaaaaaaaaaaaaa ")]


def test_where_it_may_listen() -> None:
    for host, token in ALLOWED:
        check_binding(Settings(host=host, token=token))  # type: ignore[arg-type]
    for host, token in REFUSED:
        with pytest.raises(InputError) as caught:
            check_binding(Settings(host=host, token=token))  # type: ignore[arg-type]
        assert "\n" not in str(caught.value), (host, token)
        assert caught.value.field in ("host", "token"), (host, token)


def test_a_port_that_is_taken_is_named(tmp_path: Path) -> None:
    first = bind(Settings(port=0, data=tmp_path))
    try:
        with pytest.raises(InputError, match=r"cannot listen on 127\.0\.0\.1"):
            bind(Settings(port=first.getsockname()[1], data=tmp_path))
    finally:
        first.close()


def test_the_token_is_made_once_and_only_the_owner_reads_it(tmp_path: Path) -> None:
    token = token_of(tmp_path / "data")
    assert len(token) >= 43
    assert token_of(tmp_path / "data") == token
    assert (tmp_path / "data" / "token").stat().st_mode & 0o777 == 0o600
    assert token_of(tmp_path / "other") != token


def test_a_token_file_with_no_token_in_it_gets_a_new_one(tmp_path: Path) -> None:
    for damaged in (b"\xff\xfe", b"", b"a" * 31, "\u00e9".encode() * 40, b"a" * 20 + b"\x00" * 20):
        (tmp_path / "token").write_bytes(damaged)
        (tmp_path / "token").chmod(0o644)
        token = token_of(tmp_path)
        assert len(token) >= 43 and token_of(tmp_path) == token, damaged
        assert (tmp_path / "token").stat().st_mode & 0o777 == 0o600
        assert [path.name for path in tmp_path.iterdir()] == ["token"]


def test_a_cookie_belongs_to_its_token() -> None:
    one, other = Identity("a" * 20), Identity("b" * 20)
    assert one.cookie == Identity("a" * 20).cookie != other.cookie
    assert one.is_token("a" * 20) and not one.is_token("b" * 20) and not one.is_token("")
