"""A shared link lets people without the token watch its bench, if the teacher lets them, and for as long."""

from __future__ import annotations

from typing import Any

import httpx
import pytest

from tests.server.classroom.group import Somebody, closed_with, join, open_class
from tests.server.classroom.test_classes import later
from tests.server.conftest import Live

HTML = {"Accept": "text/html"}


def share(live: Live, bench: str) -> str:
    answer = live.http.post("/api/v1/links", json={"bench": bench})
    assert answer.status_code == 201, answer.text
    return str(answer.json()["id"])


def let_watch(live: Live, bench: str, link: str, hours: float = 1.0) -> dict[str, Any]:
    answer = live.http.post(f"/api/v1/benches/{bench}/watchers", json={"hours": hours, "link": link})
    assert answer.status_code == 201, answer.text
    return dict(answer.json())


def opened(browser: httpx.Client, link: str, **options: Any) -> httpx.Response:
    """Open a shared link as a browser does."""
    return browser.get(f"/?link={link}", follow_redirects=True, **options)


def refused(live: Live, link: str) -> None:
    with live.anonymous() as browser:
        answer = opened(browser, link)
        assert (answer.status_code, answer.json()["error"]["code"]) == (403, "wrong_link")
        assert not browser.cookies and browser.get("/api/v1/me").status_code == 401
    live.advance(seconds=6.0)  # a try more from this address


def test_a_shared_link_lets_nobody_watch_until_the_teacher_says_so(live: Live) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    link = share(live, bench)
    refused(live, link)
    with live.anonymous(headers=HTML) as browser:
        shown = opened(browser, link)
        assert shown.status_code == 403 and "does not let you watch" in shown.text
        assert f'<input type="hidden" name="link" value="{link}">' in shown.text  # the token opens it all the same
        led = browser.get(shown.url.path, params={"link": link, "token": live.app.state.identity.token})
        led = browser.get(led.headers["location"])
        assert led.headers["location"] == f"/?link={link}"
    made = let_watch(live, bench, link)
    assert made["path"] == f"/?link={link}"
    with live.anonymous(headers=HTML) as browser:
        entered = browser.get(browser.get(made["path"]).headers["location"])
        assert (entered.status_code, entered.headers["location"]) == (303, "/")
        me = browser.get("/api/v1/me").json()
        assert (me["id"], me["role"], me["bench"]) == (made["id"], "watcher", bench)


def test_people_who_watch_by_a_link_see_its_bench_and_neither_sets_nor_units_nor_another_bench(live: Live) -> None:
    bench, other = (live.bench("first-look", paused=True)["id"] for _ in range(2))
    link = share(live, bench)
    let_watch(live, bench, link)
    with live.anonymous() as browser:
        opened(browser, link)
        assert browser.get(f"/api/v1/benches/{bench}").status_code == 200
        for path in (f"benches/{other}", "parameter-sets", "units", f"links/{link}", "runs"):
            answer = browser.get(f"/api/v1/{path}")
            assert (answer.status_code, answer.json()["error"]["code"]) == (403, "forbidden"), path
        command = {"kind": "start"}
        sent = browser.post(f"/api/v1/benches/{bench}/commands", json=command, headers={"Origin": live.address})
        assert sent.status_code == 403
        next_link = share(live, other)
        assert opened(browser, next_link).status_code == 403  # and the first bench stays
        assert browser.get("/api/v1/me").json()["bench"] == bench
        let_watch(live, other, next_link)
        opened(browser, next_link)
        assert browser.get("/api/v1/me").json()["bench"] == other


def test_it_ends_by_its_time_by_the_teacher_and_with_the_link(live: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    link, secret = share(live, bench), live.app.state.identity.secret_of_link
    with monkeypatch.context() as patch:
        let_watch(live, bench, link, hours=0.1)
        later(patch, "people", hours=0.2)
        refused(live, link)
    again = let_watch(live, bench, link)  # the time that was over is in the way of none
    guest = Somebody(live, secret(link), bench)
    with guest.stream() as stream:
        stream.until_type("hello")
        live.http.delete(f"/api/v1/benches/{bench}/watchers/{again['id']}")
        assert closed_with(stream) == 4401
    refused(live, link)
    let_watch(live, bench, link)
    let_watch(live, bench, link, hours=2.0)
    assert len(live.http.get(f"/api/v1/benches/{bench}/watchers").json()["watchers"]) == 1
    assert live.http.delete(f"/api/v1/links/{link}").status_code == 204
    refused(live, link)
    assert live.http.get(f"/api/v1/benches/{bench}/watchers").json()["watchers"] == []
    layout = live.http.post("/api/v1/links", json={"title": "panels", "layout": {}}).json()["id"]
    for one, status in ((link, 404), (layout, 422)):
        assert live.http.post(f"/api/v1/benches/{bench}/watchers", json={"link": one}).status_code == status


def test_it_ends_with_the_class_of_its_bench(live: Live) -> None:
    group = open_class(live)
    student = join(live, group, "Ada")
    link = share(live, student.bench)
    let_watch(live, student.bench, link)
    with live.anonymous() as browser:
        opened(browser, link)
        assert browser.get("/api/v1/me").json()["bench"] == student.bench
        live.http.delete(f"/api/v1/classes/{group['id']}")
        assert browser.get("/api/v1/me").status_code == 401
        assert opened(browser, link).json()["error"]["code"] == "wrong_link"
    live.advance(seconds=6.0)


def test_a_student_who_opens_a_shared_link_stays_a_student(live: Live) -> None:
    group = open_class(live)
    bench = live.bench("first-look", paused=True)["id"]
    link = share(live, bench)
    let_watch(live, bench, link)
    with live.anonymous(headers={"Origin": live.address, **HTML}) as browser:
        browser.post("/join", data={"code": group["code"], "name": "Ada"})
        browser.get(f"/?link={link}")
        assert browser.get("/api/v1/me").json()["role"] == "student"
    live.http.delete(f"/api/v1/classes/{group['id']}")


def test_guesses_of_links_are_limited_and_a_right_one_never_pays_for_them(live: Live) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    link = share(live, bench)
    let_watch(live, bench, link)
    with live.anonymous() as browser:
        statuses = [opened(browser, f"guess{i}").status_code for i in range(12)]
        assert set(statuses) == {403, 429} and statuses == sorted(statuses)
        opened(browser, link)
        assert browser.get("/api/v1/me").json()["bench"] == bench
    live.advance(seconds=60.0)
