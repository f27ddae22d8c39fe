"""Places of the page: the roles that may open each, their existence, and the answer to an unknown path."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from server.store.models import RequestRow
from tests.server.classroom.group import Somebody, join, open_class, the_teacher, watcher

HTML = {"Accept": "text/html,*/*"}
OPEN = (
    "/",
    "/gallery",
    "/gallery/ch5-seven-step",
    "/theory",
    "/theory/5.2.3.2",
    "/scores",
    "/design",
    "/design/lcr-350",
)
TEACHERS = ("/class", "/runs", "/runs/a1", "/runs/a1,b2")


@pytest.fixture
def page(live: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The shared server with a page that is built, and a run and a campaign."""
    (tmp_path / "index.html").write_text('<head><base href="/" /><title>the built page</title></head>')
    monkeypatch.setattr(live.app.state.page, "_folder", tmp_path)
    fields = {"state": "failed", "name": "n", "scenario_id": "s", "title": "t", "document": {}, "runs": 1}
    rows = [RequestRow(id="a1", kind="run", **fields), RequestRow(id="b2", kind="campaign", **fields)]
    live.on_loop(live.service.database.run(lambda session: session.add_all(rows)))
    yield live
    for kind, one in (("runs", "a1"), ("sweeps", "b2")):
        removed = live.http.post(f"/api/v1/{kind}/remove", json={"ids": [one]})
        assert removed.json() == {"removed": 1}


def test_each_place_opens_the_page_for_the_people_who_may_see_it(page: Any) -> None:
    group = open_class(page)
    student = join(page, group, "Ada")
    people = {
        "teacher": the_teacher(page),
        "student": student,
        "watcher": watcher(page, student.bench),
        "stranger": Somebody(page, "nobody's"),
    }
    for role, somebody in people.items():
        for path in (*OPEN, *TEACHERS):
            allowed = 200 if role == "teacher" or path in OPEN else 403
            answer = somebody.ask("GET", path)
            assert answer.status_code == (401 if role == "stranger" else allowed), (role, path)
            assert ("the built page" in answer.text) == (answer.status_code == 200)
    page.http.delete(f"/api/v1/classes/{group['id']}")


def test_head_answers_as_get_at_every_place(page: Any) -> None:
    for path in (*OPEN, *TEACHERS, "/gallery/none", "/nowhere"):
        got, head = (page.http.request(method, path, headers=HTML) for method in ("GET", "HEAD"))
        assert (head.status_code, head.content) == (got.status_code, b""), path
        assert head.headers["content-length"] == got.headers["content-length"] != "0"


@pytest.mark.parametrize("path", ["/gallery/none", "/design/none", "/runs/none", "/runs/a1,none"])
def test_a_place_with_nothing_to_show_is_404_and_the_page_says_so(page: Any, path: str) -> None:
    answer = page.http.get(path)
    assert answer.status_code == 404 and "the built page" in answer.text


@pytest.mark.parametrize("path", ["/nowhere", "/gallery/a/b", "/bench", "/documents", "/scores/1", "/gallery/"])
def test_a_path_that_is_no_place_is_404_for_browsers_and_programs(page: Any, path: str) -> None:
    browser, program = page.http.get(path, headers=HTML), page.http.get(path)
    assert browser.status_code == program.status_code == 404
    assert "the built page" in browser.text
    assert program.json()["error"]["code"] == "not_found"


def test_the_interface_keeps_its_paths(page: Any) -> None:
    bench = page.bench("first-look", paused=True)["id"]
    for path in ("/api/v1/gallery", "/health/live", f"/benches/{bench}/3d/"):
        answer = page.http.get(path, headers=HTML)
        assert answer.status_code == 200 and "the built page" not in answer.text
    assert page.http.get("/api/gallery", headers=HTML).json()["error"]["code"] == "not_found"
