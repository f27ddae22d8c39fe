"""The site of the documents at /docs: its pages, its files, and the answers where there is none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from server.api import documents
from server.api.documents import NOT_BUILT

HTML = {"Accept": "text/html,*/*"}


@pytest.fixture
def site(live: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The shared server with a site of two pages, and a secret beside it."""
    folder = tmp_path / "site"
    (folder / "reference").mkdir(parents=True)
    (folder / "index.html").write_text("<h1>first page</h1>")
    (folder / "reference" / "index.html").write_text("<h1>reference</h1>")
    (folder / "search.js").write_text("search()")
    (tmp_path / "secret.txt").write_text("secret")
    monkeypatch.setattr(documents, "SITE", folder)
    return live


def test_pages_and_files_of_the_site(site: Any) -> None:
    led = site.http.get("/docs")
    assert (led.status_code, led.headers["location"]) == (308, "/docs/")
    for path, text in (("", "first page"), ("index.html", "first page"), ("reference/", "reference")):
        answer = site.http.get(f"/docs/{path}")
        assert answer.status_code == 200 and text in answer.text
        assert answer.headers["content-type"].startswith("text/html")
    script = site.http.get("/docs/search.js")
    assert "javascript" in script.headers["content-type"] and script.headers["cache-control"] == "no-cache"
    assert site.http.get("/docs/search.js", headers={"If-None-Match": script.headers["etag"]}).status_code == 304


def test_the_policy_of_the_page_holds_there(site: Any) -> None:
    policy = site.http.get("/docs/").headers["content-security-policy"]
    assert "script-src 'self';" in policy and "style-src-elem 'self' 'nonce-" in policy


@pytest.mark.parametrize("path", ["none.html", "reference", "../secret.txt", "%2e%2e/secret.txt", "..%2fsecret.txt"])
def test_nothing_else_is_served(site: Any, path: str) -> None:
    answer = site.http.get(f"/docs/{path}")
    assert answer.status_code == 404 and answer.json()["error"]["code"] == "not_found"
    assert "secret" not in site.http.get(f"/docs/{path}", headers=HTML).text.replace("secret.txt", "")


def test_a_server_without_the_site_says_how_to_build_it(live: Any, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr(documents, "SITE", tmp_path)
    answer = live.http.get("/docs/", headers=HTML)
    assert answer.status_code == 404 and NOT_BUILT.partition("`")[0].strip() in answer.text
    assert live.http.get("/api/v1/me").json()["documents"] is False


def test_the_page_offers_the_site_where_there_is_one(site: Any) -> None:
    assert site.http.get("/api/v1/me").json()["documents"] is True
