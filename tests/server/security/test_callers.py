"""Origin of a request: the headers of a proxy count only from trusted proxies."""

from __future__ import annotations

from typing import Any

import pytest
from starlette.requests import HTTPConnection

from core.errors import InputError
from server.security.callers import Callers
from server.settings import load_settings

CASES: list[tuple[list[str], str, list[str], str]] = [
    ([], "127.0.0.1", ["9.9.9.9"], "127.0.0.1"),
    (["127.0.0.1"], "127.0.0.1", ["9.9.9.9"], "9.9.9.9"),
    (["127.0.0.1"], "8.8.8.8", ["9.9.9.9"], "8.8.8.8"),
    (["127.0.0.1"], "127.0.0.1", [], "127.0.0.1"),
    (["127.0.0.1"], "127.0.0.1", ["1.1.1.1, 9.9.9.9"], "9.9.9.9"),
    (["127.0.0.1", "10.0.0.0/8"], "127.0.0.1", ["1.1.1.1, 9.9.9.9, 10.0.0.7"], "9.9.9.9"),
    (["127.0.0.1", "10.0.0.0/8"], "127.0.0.1", ["1.1.1.1", "9.9.9.9"], "9.9.9.9"),
    (["::1"], "::1", ["2001:db8::5"], "2001:db8::5"),
    (["127.0.0.1"], "127.0.0.1", ["nonsense"], "nonsense"),
    (["127.0.0.1"], "127.0.0.1", ["x" * 500], "x" * 64),
    (["127.0.0.1"], "127.0.0.1", ["9.9.9.9, "], "127.0.0.1"),
]


@pytest.mark.parametrize(("trusted", "peer", "said", "address"), CASES)
def test_the_address_is_that_of_the_first_caller_who_is_no_trusted_proxy(
    trusted: list[str], peer: str, said: list[str], address: str
) -> None:
    headers = [(b"x-forwarded-for", one.encode()) for one in said]
    connection = HTTPConnection({"type": "http", "client": (peer, 1), "headers": headers})
    assert Callers(trusted).address(connection) == address


def test_a_setting_that_is_no_address_is_refused(monkeypatch: pytest.MonkeyPatch, tmp_path: Any) -> None:
    monkeypatch.chdir(tmp_path)
    assert load_settings(trusted_proxies=["10.0.0.0/8", "::1"]).trusted_proxies == ["10.0.0.0/8", "::1/128"]
    with pytest.raises(InputError, match="trusted_proxies"):
        load_settings(trusted_proxies=["the proxy"])


def test_behind_a_trusted_proxy_each_address_has_limits_of_its_own(serve: Any) -> None:
    with serve(trusted_proxies=["127.0.0.1"]) as live, live.anonymous() as client:

        def guessed(address: str, count: int) -> list[int]:
            form, headers = {"code": "xxxx", "name": "Eve"}, {"X-Forwarded-For": address, "Origin": live.address}
            return [client.post("/join", data=form, headers=headers).status_code for _ in range(count)]

        assert guessed("9.9.9.9", 9)[-1] == 429
        assert guessed("8.8.8.8", 1) == [403]
