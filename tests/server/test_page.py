"""The page: served as built, helpful when it is not, never in the way of the interface."""

from __future__ import annotations

import asyncio
import contextlib
import gzip
from pathlib import Path
from typing import Any

import pytest
from starlette.exceptions import HTTPException

from server.api.page import Page


@pytest.fixture
def dist(tmp_path: Path) -> Path:
    folder = tmp_path / "dist"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text('<head><base href="/" /><title>the page</title></head>')
    (folder / "assets" / "app-1a2b.js").write_text("let x")
    (folder / "favicon.svg").write_text("<svg/>")
    (tmp_path / "secret.txt").write_text("secret")
    return folder


def get(page: Page, path: str, method: str = "GET", accepts: str = "", html: bool = False) -> Any:
    sent: list[dict[str, Any]] = []

    async def send(message: Any) -> None:
        sent.append(message)

    async def receive() -> Any:
        await asyncio.Event().wait()

    told = [(b"accept-encoding", accepts.encode())] if accepts else []
    told += [(b"accept", b"text/html,*/*")] if html else []
    scope = {"type": "http", "method": method, "path": path, "headers": told, "query_string": b"", "root_path": ""}
    asyncio.run(page(scope, receive, send))
    headers = {name.decode(): value.decode() for name, value in sent[0]["headers"]}
    return sent[0]["status"], headers, b"".join(message.get("body", b"") for message in sent[1:])


def test_the_page_is_at_the_root(dist: Path) -> None:
    status, headers, body = get(Page(dist), "/")
    assert (status, headers["cache-control"]) == (200, "no-cache")
    assert b"the page" in body


def test_a_path_that_is_no_place_is_404_and_the_page_says_so_in_a_browser(dist: Path) -> None:
    for path in ("/bench/abc", "/some/path/inside", "//evil.example"):
        status, headers, body = get(Page(dist), path, html=True)
        assert (status, headers["cache-control"]) == (404, "no-cache") and b"the page" in body
        with pytest.raises(HTTPException) as caught:
            get(Page(dist), path)
        assert caught.value.status_code == 404


@pytest.mark.parametrize("prefix", ["", "/bench", "/a/b"])
def test_addresses_in_the_page_begin_at_its_root_whatever_its_depth(dist: Path, prefix: str) -> None:
    for path in ("/", "/some/path/inside", "//x"):
        assert f'<base href="{prefix}/" />'.encode() in get(Page(dist, prefix), path, html=True)[2]


def test_assets_with_a_hash_in_their_name_are_kept_by_the_browser(dist: Path) -> None:
    status, headers, body = get(Page(dist), "/assets/app-1a2b.js")
    assert status == 200 and "immutable" in headers["cache-control"] and body == b"let x"
    assert get(Page(dist), "/favicon.svg")[1]["cache-control"] == "no-cache"


def test_who_takes_gzip_gets_what_the_build_has_compressed(dist: Path) -> None:
    (dist / "assets" / "app-1a2b.js.gz").write_bytes(gzip.compress(b"let x"))
    for accepts, is_compressed in (
        ("gzip, deflate, br", True),
        ("br;q=1.0, GZIP;q=0.5", True),
        ("", False),
        ("gzip;q=0, br", False),
        ("x-gzip", False),
    ):
        status, headers, body = get(Page(dist), "/assets/app-1a2b.js", accepts=accepts)
        assert status == 200 and headers["content-type"].startswith("text/javascript") and "immutable" in str(headers)
        assert headers.get("content-encoding") == ("gzip" if is_compressed else None)
        assert (gzip.decompress(body) if is_compressed else body) == b"let x"
        assert headers["vary"] == "Accept-Encoding"
        assert get(Page(dist), "/favicon.svg", accepts=accepts)[2] == b"<svg/>"  # which the build has not compressed


def test_what_is_not_there_is_not_the_page(dist: Path) -> None:
    for path in ("/api/v1/nothing", "/assets/nothing.js", "/benches/x/y", "/health/x"):
        with pytest.raises(HTTPException) as caught:
            get(Page(dist), path, html=True)
        assert caught.value.status_code == 404


def test_nothing_outside_the_build_is_served(dist: Path) -> None:
    for path in ("/../secret.txt", "/assets/../../secret.txt", "//secret.txt", "/..%2fsecret.txt"):
        with contextlib.suppress(HTTPException):
            assert b"secret" not in get(Page(dist), path)[2], path


def test_without_a_build_it_says_what_to_do(tmp_path: Path) -> None:
    status, _, body = get(Page(tmp_path / "none"), "/")
    assert status == 503 and b"make run" in body


def test_the_catalogue_is_the_same_with_and_without_compression(live: Any) -> None:
    plain = live.http.get("/api/v1/catalog", headers={"Accept-Encoding": "identity"})
    compressed = live.http.get("/api/v1/catalog", headers={"Accept-Encoding": "gzip"})
    assert "content-encoding" not in plain.headers and compressed.headers["content-encoding"] == "gzip"
    assert int(compressed.headers["content-length"]) < int(plain.headers["content-length"]) / 5
    assert plain.headers["vary"] == compressed.headers["vary"] == "Accept-Encoding"
    assert plain.json() == compressed.json()
    of_plants = live.http.get("/api/v1/catalog?family=plant").json()["blocks"]
    assert of_plants == [block for block in plain.json()["blocks"] if block["family"] == "plant"]
    assert live.http.get("/api/v1/catalog?family=nothing").status_code == 422
