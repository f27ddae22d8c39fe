"""The page: served as built, helpful when it is not, never in the way of the interface."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import pytest
from starlette.exceptions import HTTPException

from server.page import Page


@pytest.fixture
def dist(tmp_path: Path) -> Path:
    folder = tmp_path / "dist"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text("<title>the page</title>")
    (folder / "assets" / "app-1a2b.js").write_text("let x")
    (folder / "favicon.svg").write_text("<svg/>")
    (tmp_path / "secret.txt").write_text("secret")
    return folder


def get(page: Page, path: str, method: str = "GET", query: bytes = b"") -> Any:
    sent: list[dict[str, Any]] = []

    async def send(message: Any) -> None:
        sent.append(message)

    async def receive() -> Any:
        await asyncio.Event().wait()

    scope = {"type": "http", "method": method, "path": path, "headers": [], "query_string": query, "root_path": ""}
    asyncio.run(page(scope, receive, send))
    headers = {name.decode(): value.decode() for name, value in sent[0]["headers"]}
    return sent[0]["status"], headers, b"".join(message.get("body", b"") for message in sent[1:])


def test_the_page_is_at_the_root(dist: Path) -> None:
    status, headers, body = get(Page(dist), "/")
    assert (status, headers["cache-control"]) == (200, "no-cache")
    assert b"the page" in body


@pytest.mark.parametrize("path", ["/bench/abc", "/some/path/inside", "//evil.example"])
def test_a_path_that_is_nothing_leads_to_the_page(dist: Path, path: str) -> None:
    """All addresses in the page are relative, so it works at the root alone."""
    assert get(Page(dist), path)[:2] == (303, {"location": "/", "content-length": "0"})
    assert get(Page(dist), path, query=b"page=runs")[1]["location"] == "/?page=runs"


def test_assets_with_a_hash_in_their_name_are_kept_by_the_browser(dist: Path) -> None:
    status, headers, body = get(Page(dist), "/assets/app-1a2b.js")
    assert status == 200 and "immutable" in headers["cache-control"] and body == b"let x"
    assert get(Page(dist), "/favicon.svg")[1]["cache-control"] == "no-cache"


@pytest.mark.parametrize("path", ["/api/v1/nothing", "/assets/nothing.js", "/benches/x/y", "/health/x"])
def test_what_is_not_there_is_not_the_page(dist: Path, path: str) -> None:
    with pytest.raises(HTTPException) as caught:
        get(Page(dist), path)
    assert caught.value.status_code == 404


@pytest.mark.parametrize("path", ["/../secret.txt", "/assets/../../secret.txt", "//secret.txt", "/..%2fsecret.txt"])
def test_nothing_outside_the_build_is_served(dist: Path, path: str) -> None:
    try:
        _, _, body = get(Page(dist), path)
    except HTTPException:
        return
    assert b"secret" not in body


def test_without_a_build_it_says_what_to_do(tmp_path: Path) -> None:
    status, _, body = get(Page(tmp_path / "none"), "/")
    assert status == 503 and b"make run" in body
