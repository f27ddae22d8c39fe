"""Launches: the good one, and each that has to be refused."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import jwt
import pytest
from sqlalchemy import select

from server.store.people import LtiKeyRow
from tests.server.classroom.group import Somebody
from tests.server.classroom.lti.browser import Browser
from tests.server.classroom.lti.platform import CLAIM, KID, MEMBERSHIP, key_of
from tests.server.conftest import Live
from tests.server.world import Injector


def me(lab: Live, secret: str) -> dict[str, Any]:
    return Somebody(lab, secret).me()


def test_a_learner_gets_a_bench_and_the_sheet_of_the_link(lab: Live, browser: Browser) -> None:
    answer = browser.launch()
    assert answer.status_code == 303 and answer.headers["location"].startswith("/lti?layout=lab#launch=")
    secret = browser.exchange(answer).json()["session"]
    found = me(lab, secret)
    assert (found["role"], found["name"], found["class_name"]) == ("student", "Ada Lovelace", "Microsystems")
    sheets = Somebody(lab, secret).ask("GET", "/api/v1/sheets").json()
    assert sheets["current"] == "first-look"
    with Somebody(lab, secret, found["bench"]).stream() as stream:
        assert stream.until_type("hello")["bench"]["id"] == found["bench"]
    again = browser.session()
    assert me(lab, again) == found, "the same student, on the same bench"
    assert Somebody(lab, secret).ask("GET", "/api/v1/me").status_code == 401, "the session before has ended"
    assert len(lab.service.people.students(found["class_id"])) == 1


def test_a_tab_of_its_own_gets_the_usual_cookie(lab: Live, browser: Browser) -> None:
    answer = browser.exchange(browser.launch(), framed=False)
    assert answer.json() == {"session": None}
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie and "SameSite=strict" in cookie
    with lab.anonymous(headers={"Cookie": cookie.partition(";")[0]}) as client:
        assert client.get("/api/v1/me").json()["name"] == "Ada Lovelace"


def test_what_works_once_works_once(browser: Browser) -> None:
    browser.begin()
    message = browser.platform.sign(browser.platform.claims(browser.asked["nonce"]))
    answer = browser.end(message)
    assert browser.exchange(answer).status_code == 200
    assert browser.exchange(answer).json()["error"]["code"] == "lti_refused", "the code"
    replayed = browser.end(message)
    assert replayed.status_code == 403 and "has been used" in replayed.text, "the state"
    browser.begin()
    replayed = browser.end(message)
    assert replayed.status_code == 403 and "Nonce" in replayed.text, "the nonce"
    assert "has been used" in browser.end(message, "state-of-somebody").text


def test_a_launch_ends_in_the_browser_that_began_it(browser: Browser) -> None:
    answer = browser.exchange(browser.launch(), browser="what another browser has")
    assert answer.status_code == 403 and answer.json()["error"]["code"] == "lti_refused"


REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"aud": "another tool"}, "Could not|not registered|Registration"),
    ({"aud": ["combbench", "another tool"]}, "several tools"),
    ({"iss": "https://stranger.example"}, "Registration"),
    ({"exp": int(time.time()) - 100}, "expired"),
    ({"exp": None}, "exp"),
    ({f"{CLAIM}deployment_id": "2"}, "deployment"),
    ({f"{CLAIM}version": "1.1"}, "version"),
    ({f"{CLAIM}resource_link": {}}, "Resource Link"),
    ({f"{CLAIM}message_type": "DataPrivacyLaunchRequest"}, "Resource link claim|only links"),
    ({f"{CLAIM}roles": ["http://purl.imsglobal.org/vocab/lis/v2/institution/person#Guest"]}, "nly students"),
    ({"sub": None}, "user"),
]


def test_a_message_that_is_not_for_us_is_refused(browser: Browser) -> None:
    wrong = []
    for changed, why in REFUSED:
        browser.begin()
        claims = {**browser.platform.claims(browser.asked["nonce"]), **changed}
        kept = {name: value for name, value in claims.items() if value is not None}
        answer = browser.end(browser.platform.sign(kept))
        says_why = any(part in answer.text for part in why.split("|"))
        if answer.status_code != 403 or not says_why or "<h1>The bench did not open</h1>" not in answer.text:
            wrong.append((changed, answer.status_code, answer.text))
    assert wrong == []


def test_a_message_of_a_foreign_key_or_of_none_is_refused(browser: Browser) -> None:
    def refused(make: Any) -> str:
        browser.begin()
        answer = browser.end(make(browser.platform.claims(browser.asked["nonce"])))
        assert answer.status_code == 403
        return str(answer.text)

    assert "Signature" in refused(lambda claims: browser.platform.sign(claims, key_of("a stranger")))
    assert "public key" in refused(lambda claims: jwt.encode(claims, None, "none", {"kid": KID}))
    assert "public key" in refused(
        lambda claims: jwt.encode(claims, "a secret of thirty-two characters", "HS256", {"kid": KID})
    )
    assert "KID" in refused(lambda claims: jwt.encode(claims, browser.platform.key, "RS256"))
    assert "3 parts" in refused(lambda _: "no message")
    assert "decoded" in refused(lambda _: "a.b.c")


def test_a_launch_ends_at_the_platform_where_it_began(browser: Browser, platforms: Any) -> None:
    browser.begin()
    other = platforms[1]
    answer = browser.end(other.sign(other.claims(browser.asked["nonce"])))
    assert answer.status_code == 403 and "another platform" in answer.text


def test_two_platforms_are_two_classes(lab: Live, browser: Browser, platforms: Any) -> None:
    one = me(lab, browser.session())
    other = me(lab, Browser(lab, platforms[1]).session())
    assert one["name"] == other["name"] and one["class_id"] != other["class_id"]
    course = {f"{CLAIM}context": {"id": "course-2", "label": "MS\n2"}}
    third = me(lab, browser.session(**course))
    assert third["class_name"] == "MS 2" and third["class_id"] != one["class_id"]


def test_names_are_cleaned_and_nobodys_else(lab: Live, browser: Browser) -> None:
    def named(sub: str, **claims: Any) -> str:
        return str(me(lab, browser.session(sub=sub, **claims))["name"])

    assert named("a", name="Grace\n\u202eHopper") == "Grace Hopper"
    assert named("b", name="Grace Hopper") == "Grace Hopper 2"
    assert named("c", name="teacher of all") == "Student"
    assert named("d", name="", given_name="Emmy", family_name="Noether") == "Emmy Noether"
    assert len(named("e", name="x" * 200)) == 40


def test_an_instructor_opens_the_class_and_gets_no_rights(lab: Live, browser: Browser) -> None:
    course = {f"{CLAIM}context": {"id": "course-3", "title": "Sensors <b>"}}
    answer = browser.launch(role="Instructor", **course)
    assert answer.status_code == 200 and "You teach this course" in answer.text
    assert "Sensors &lt;b&gt;" in answer.text and "0 students have" in answer.text
    assert "set-cookie" not in answer.headers
    classes = [one["name"] for one in lab.http.get("/api/v1/classes").json()["classes"]]
    assert classes.count("Sensors <b>") == 1
    both = [MEMBERSHIP + "Learner", MEMBERSHIP.replace("#", "/Instructor#TeachingAssistant")]
    assert "You teach" in browser.launch(**course, **{f"{CLAIM}roles": both}).text


def test_a_scenario_or_an_unknown_exercise(lab: Live, browser: Browser) -> None:
    person = me(lab, browser.session(sub="s", **{f"{CLAIM}custom": {"scenario": "ch5-seven-step"}}))
    assert lab.service.benches.get(person["bench"]).scenario.id == "ch5-seven-step"
    for custom in ({"scenario": "nothing"}, {"sheet": "nothing"}):
        answer = browser.exchange(browser.launch(sub="s", **{f"{CLAIM}custom": custom}))
        assert answer.status_code == 404 and "'nothing'" in answer.json()["error"]["message"]


def test_what_is_kept_names_nobody_of_the_platform(lab: Live, browser: Browser) -> None:
    browser.session(sub="a-user-id-to-look-for", **{f"{CLAIM}context": {"id": "a-course-id-to-look-for"}})
    folder = Path(lab.service.settings.data)
    for file in folder.glob("combbench.sqlite3*"):
        assert b"to-look-for" not in file.read_bytes()
    assert (folder / "lti-key.pem").stat().st_mode & 0o777 == 0o600


def test_a_platform_that_is_not_configured_begins_nothing(browser: Browser) -> None:
    assert browser.begin(iss="https://stranger.example").status_code == 403
    assert browser.begin(client_id="another tool").status_code == 403
    assert browser.begin(login_hint="").status_code == 403


def test_a_launch_that_the_database_refuses_leaves_no_second_class_and_no_second_student(
    lab: Live, browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    injector, calls = Injector(lab, monkeypatch), 0
    while True:
        answer = browser.launch()
        injector.arm(calls)
        exchanged = browser.exchange(answer)
        injector.is_armed = False
        if not injector.has_failed:
            break
        assert exchanged.status_code == 503
        calls += 1
    assert calls > 5 and exchanged.status_code == 200
    [group] = lab.http.get("/api/v1/classes").json()["classes"]
    assert group["students"] == 1
    rows = lab.service.database.transact(lambda session: list(session.scalars(select(LtiKeyRow))))
    assert [row.person_id is None for row in rows].count(True) == 1 and len(rows) == 2
