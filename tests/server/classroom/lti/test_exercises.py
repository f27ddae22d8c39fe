"""The choice of an exercise, and the scores that come back."""

from __future__ import annotations

import asyncio
from datetime import datetime
from pathlib import Path
from typing import Any

import jwt

from server.classroom.lti.tool import Tool
from tests.server.classroom.group import Somebody, on_loop
from tests.server.classroom.lti.browser import Browser
from tests.server.classroom.lti.platform import CLAIM, DEEP_LINKING, GRADES, MEMBERSHIP, SCORE
from tests.server.conftest import Live


def settle(lab: Live) -> None:
    """Wait until every score has been sent."""

    async def sent() -> None:
        await asyncio.gather(*lab.app.state.lti.scores._tasks.values())

    on_loop(lab, sent())


def choose(browser: Browser, choice: str, **changed: Any) -> Any:
    """Choose an exercise as an instructor; return the answer."""
    browser.begin()
    answer = browser.end(browser.platform.sign({**browser.platform.choice(browser.asked["nonce"]), **changed}))
    assert answer.status_code == 200, answer.text
    code = answer.text.partition("name='code' value='")[2].partition("'")[0]
    with browser.live.anonymous(headers={"Origin": browser.live.address}) as client:
        return client.post("/lti/link", data={"code": code, "choice": choice}), answer, code


def test_the_choice_of_a_sheet_is_signed_and_has_a_column_of_points(lab: Live, browser: Browser) -> None:
    answer, asked, code = choose(browser, "sheet:first-look")
    assert "value='sheet:first-look'" in asked.text and "value='scenario:ch5-seven-step'" in asked.text
    assert f"action='{browser.platform.url}/choice'" in answer.text
    message = answer.text.partition("name='JWT' value='")[2].partition("'")[0]
    with lab.anonymous() as client:
        keys = jwt.PyJWKSet.from_dict(client.get("/lti/jwks").json())
    key = keys[jwt.get_unverified_header(message)["kid"]].key
    claims = jwt.decode(message, key, ["RS256"], audience=browser.platform.url, issuer="combbench")
    assert claims[f"{CLAIM}message_type"] == "LtiDeepLinkingResponse"
    assert claims[f"{CLAIM}deployment_id"] == "1"
    assert claims["https://purl.imsglobal.org/spec/lti-dl/claim/data"] == "to be sent back"
    [item] = claims["https://purl.imsglobal.org/spec/lti-dl/claim/content_items"]
    assert item["custom"] == {"sheet": "first-look"} and item["url"] == f"{lab.address}/lti/launch"
    assert item["lineItem"]["scoreMaximum"] == lab.service.sheets.get("first-look").points
    with lab.anonymous(headers={"Origin": lab.address}) as client:
        again = client.post("/lti/link", data={"code": code, "choice": "sheet:first-look"})
    assert again.status_code == 403, "a choice is made once"


def test_a_bench_can_be_chosen_and_nothing_else(browser: Browser) -> None:
    answer, _, _ = choose(browser, "scenario:ch5-seven-step")
    message = answer.text.partition("name='JWT' value='")[2].partition("'")[0]
    [item] = jwt.decode(message, options={"verify_signature": False})[
        "https://purl.imsglobal.org/spec/lti-dl/claim/content_items"
    ]
    assert item["custom"] == {"scenario": "ch5-seven-step"} and "lineItem" not in item
    for choice in ("sheet:nothing", "scenario:../x", "", "x:y"):
        assert choose(browser, choice)[0].status_code == 404


def test_only_an_instructor_chooses_and_the_answer_goes_to_the_web(browser: Browser) -> None:
    browser.begin()
    claims = browser.platform.choice(browser.asked["nonce"])
    answer = browser.end(browser.platform.sign({**claims, f"{CLAIM}roles": [MEMBERSHIP + "Learner"]}))
    assert answer.status_code == 403 and "instructor" in answer.text
    browser.begin()
    claims = browser.platform.choice(browser.asked["nonce"])
    settings = {**claims[DEEP_LINKING], "deep_link_return_url": "javascript:alert(1)"}
    answer = browser.end(browser.platform.sign({**claims, DEEP_LINKING: settings}))
    assert answer.status_code == 403


def go_on(student: Somebody) -> bool:
    """Close the step that is open, without earning anything by it; return whether there was one."""
    sheet = "/api/v1/sheets/first-look"
    steps = [one["step"] for one in student.ask("GET", sheet).json()["sections"] if one["state"] == "open"]
    for step in steps:
        if step["kind"] == "prediction":
            answer = student.ask("POST", f"{sheet}/steps/{step['id']}/answer", json={"answer": "stays"})
        else:
            answer = student.ask("POST", f"{sheet}/steps/{step['id']}/close")
        assert answer.status_code in (200, 409), answer.text  # 409: it has closed by itself
    return bool(steps)


def test_a_score_is_sent_when_it_changes_and_at_last_as_final(browser: Browser) -> None:
    platform = browser.platform
    student = Somebody(browser.live, browser.session(sub="user-18"))
    assert go_on(student)
    settle(browser.live)
    first = platform.scores[-1]
    assert first["userId"] == "user-18" and first["type"] == "application/vnd.ims.lis.v1.score+json"
    assert (first["activityProgress"], first["gradingProgress"]) == ("InProgress", "Pending")
    assert 0 <= first["scoreGiven"] < first["scoreMaximum"] and " of " in first["comment"]
    while go_on(student):
        pass
    settle(browser.live)
    last = platform.scores[-1]
    assert (
        last["activityProgress"] == "Completed"
        and last["gradingProgress"] == "FullyGraded"
        and "all steps" in last["comment"]
    )
    assert datetime.fromisoformat(last["timestamp"]) > datetime.fromisoformat(first["timestamp"])
    token = platform.tokens[-1]
    assert token["scope"] == SCORE and token["grant_type"] == "client_credentials"
    with browser.live.anonymous() as client:
        keys = jwt.PyJWKSet.from_dict(client.get("/lti/jwks").json())
    key = keys[jwt.get_unverified_header(token["client_assertion"])["kid"]].key
    said = jwt.decode(token["client_assertion"], key, ["RS256"], audience=f"{platform.url}/token")
    assert said["iss"] == said["sub"] == "combbench"
    platform.scores.clear()
    browser.session(sub="user-18")
    settle(browser.live)
    assert [one["gradingProgress"] for one in platform.scores] == ["FullyGraded"], "a launch sends it again"


def test_a_platform_that_hangs_and_fails_is_asked_again_and_the_teacher_reads_it(lab: Live, browser: Browser) -> None:
    platform = browser.platform
    platform.refusals = 2
    platform.is_free.clear()
    student = Somebody(lab, browser.session(sub="user-19"))
    assert go_on(student)
    assert student.me()["name"] and platform.scores == [], "the server answers meanwhile"
    platform.is_free.set()
    settle(lab)
    assert len(platform.scores) == 1
    entries = lab.http.get(f"/api/v1/classes/{student.me()['class_id']}/audit").json()["entries"]
    said = [entry["text"] for entry in entries if entry["actor"] == "lti" and entry["kind"] == "grade"]
    assert len(said) == 2 and "answered 503; it is tried again" in said[1] and "sent after all" in said[0]


def test_without_a_column_no_score_is_sent(lab: Live, browser: Browser) -> None:
    scores = lab.app.state.lti.scores
    student = Somebody(lab, browser.session(sub="user-20", **{GRADES: {"scope": [], "lineitem": "x"}}))
    before = set(scores._targets)
    assert go_on(student) and set(scores._targets) == before
    assert browser.platform.scores == []


def test_what_is_entered_in_a_platform(lab: Live, tmp_path: Path) -> None:
    with lab.anonymous() as client:
        found = client.get("/lti/configuration").json()
    assert found["oidc_initiation_url"] == f"{lab.address}/lti/login"
    assert (
        found["public_jwk_url"] == f"{lab.address}/lti/jwks" and found["target_link_uri"] == f"{lab.address}/lti/launch"
    )
    folder = Path(lab.service.settings.data)
    key = (folder / "lti-key.pem").read_bytes()
    assert Tool([], folder).key_set() == lab.app.state.lti.tool.key_set(), "it stays"
    assert Tool([], tmp_path).key_set() != Tool([], folder).key_set()
    assert Tool([], tmp_path).hash_of("a", "bc") != Tool([], tmp_path).hash_of("ab", "c")
    assert (tmp_path / "lti-key.pem").read_bytes() != key
