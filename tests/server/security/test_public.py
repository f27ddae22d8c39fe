"""The address of the page behind a proxy: the accepted values, and their effects."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import httpx
import pytest

from core.errors import InputError
from server.app import create_app
from server.security.identity import Identity
from server.security.public import PublicOrigin
from server.settings import Settings, load_settings
from tests.server.conftest import TOKEN, Live

WRITTEN = [
    ("", "", "", ""),
    ("https://lab.example", "https://lab.example", "", "lab.example"),
    ("https://lab.example/", "https://lab.example", "", "lab.example"),
    ("HTTPS://Lab.Example:443/bench/", "https://lab.example", "/bench", "lab.example"),
    ("http://lab.example:80", "http://lab.example", "", "lab.example"),
    ("https://lab.example:8443/a/b-c", "https://lab.example:8443", "/a/b-c", "lab.example"),
    ("https://[2001:DB8::1]:8443", "https://[2001:db8::1]:8443", "", "[2001:db8::1]"),
    ("https://10.0.0.7", "https://10.0.0.7", "", "10.0.0.7"),
]
NONE = [
    "lab.example", "//lab.example", "ftp://lab.example", "https://", "https:///bench", "https://lab.example:port",
    "https://lab.example:70000", "https://user:word@lab.example", "https://lab.example?a=1", "https://lab.example#a",
    "https://lab.example/a/../b", "https://lab.example//evil", "https://lab.example/a b", "https://lab.example/%2e",
    "https://lab.example/a;Secure", "https://b\u00fccher.example", "https://lab example", "null", "*",
    "https://[::1", "https://lab.example\r\nx: y",
]  # fmt: skip
COOKIES = [
    ("", "combbench-", "/"),
    ("http://lab.example", "combbench-", "/"),
    ("http://lab.example/bench", "combbench-", "/bench/"),
    ("https://lab.example", "__Host-combbench-", "/"),
    ("https://lab.example/bench", "__Secure-combbench-", "/bench/"),
]
LOOPBACK = "http://127.0.0.1:8000"


def ask(folder: Path, public: str, *requests: dict[str, Any]) -> list[httpx.Response]:
    """Ask a service that does not run, so that it has no bench."""
    transport = httpx.ASGITransport(create_app(Settings(data=folder, token=TOKEN, public_origin=public)))

    async def answers() -> list[httpx.Response]:
        async with httpx.AsyncClient(transport=transport, base_url=LOOPBACK) as client:
            return [await client.request(**{"method": "GET", **request}) for request in requests]

    return asyncio.run(answers())


def test_it_is_written_as_a_browser_writes_it() -> None:
    for given, origin, prefix, host in WRITTEN:
        found = PublicOrigin.parse(given)
        assert (found.origin, found.prefix, found.host) == (origin, prefix, host), given
        assert Settings(public_origin=given).public_origin == origin + prefix, given


def test_anything_else_is_refused_at_the_start_in_one_line() -> None:
    for given in NONE:
        with pytest.raises(InputError, match=r"'public_origin' from command line: must") as caught:
            load_settings(public_origin=given)
        assert "\n" not in str(caught.value) and "lab.example" in str(caught.value), given


@pytest.mark.parametrize(("given", "prefix", "path"), COOKIES)
def test_the_cookie_is_for_that_address_alone(tmp_path: Path, given: str, prefix: str, path: str) -> None:
    (answer,) = ask(tmp_path, given, {"url": f"/?token={TOKEN}&a=1"})
    cookie = answer.headers["set-cookie"]
    assert answer.headers["location"] == f"{path}?a=1"
    assert cookie.startswith(f"{prefix}{Identity(TOKEN).cookie_name[-8:]}=")
    parts = {part.strip().lower() for part in cookie.split(";")[1:]}
    assert {f"path={path}", "httponly", "samesite=strict"} <= parts
    assert ("secure" in parts) == given.startswith("https")
    assert not any(part.startswith("domain") for part in parts)


@pytest.mark.parametrize("public", ["https://lab.example", "https://lab.example:8443/bench"])
def test_it_is_the_one_origin_and_nothing_a_client_says_changes_that(tmp_path: Path, public: str) -> None:
    origin, bearer = PublicOrigin.parse(public).origin, {"Authorization": f"Bearer {TOKEN}"}
    strangers = ["http://lab.example", f"{origin}.evil", f"{origin}/", "https://lab.example:1", "null", origin.upper()]
    claims = [{}, {"X-Forwarded-Proto": "http"}, {"X-Forwarded-Host": "lab.example"}, {"Forwarded": "proto=http"}]
    given = [
        {**bearer, "Host": host, "Origin": one, **claim}
        for host in ("lab.example", "LAB.example:8443", "127.0.0.1")
        for claim in claims
        for one in (origin, LOOPBACK, *strangers)
    ]
    fork = {"method": "POST", "url": "/api/v1/benches/x/fork", "json": {}}
    evil = {"url": "/api/v1/benches", "headers": {**bearer, "Host": "evil.example"}}
    *answers, last = ask(tmp_path, public, *({**fork, "headers": headers} for headers in given), evil)
    for headers, answer in zip(given, answers, strict=True):
        assert answer.status_code == (404 if headers["Origin"] == origin else 403), headers
    assert last.status_code == 403


def test_whatever_an_answer_leads_to_is_below_it(live: Live, serve: Any) -> None:
    with serve(public_origin="https://lab.example/bench") as below:
        for server, public, prefix in ((live, "", ""), (below, "https://lab.example/bench", "/bench")):
            made = server.http.post("/api/v1/benches", json={"scenario": "first-look", "paused": True})
            assert made.headers["location"] == f"{prefix}/api/v1/benches/{made.json()['id']}"
            document = server.http.get("/api/v1/openapi.json").json()
            assert [one["url"] for one in document["servers"]] == [public or "http://{host}:{port}"]
            with server.anonymous(headers={"Sec-Fetch-Site": "cross-site"}) as stranger:
                answer = stranger.get(f"/some/page?token={TOKEN}&a=1")
            assert f'content="0;url={prefix}/some/page?a=1"' in answer.text


def test_without_it_a_header_does_not_make_the_service_believe_in_tls(live: Any) -> None:
    headers = {"X-Forwarded-Proto": "https", "Origin": live.address.replace("http:", "https:")}
    assert live.http.post("/api/v1/benches/x/fork", json={}, headers=headers).status_code == 403
