"""Platforms as they are: other clocks, several tools, other kinds of keys, keys that change or do not come."""

from __future__ import annotations

import random
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from cryptography.hazmat.primitives.asymmetric import ec
from jwt.algorithms import ECAlgorithm

from server.classroom.lti.keys import AGAIN_S, KEPT_S
from tests.server.classroom.lti.browser import Browser
from tests.server.classroom.lti.platform import CLAIM, DEEP_LINKING, GRADES, KID, key_of, public_key
from tests.server.conftest import Live

NOW = 1_800_000_000


@pytest.fixture
def messages(lab: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    """The server takes it for a certain time of day."""
    monkeypatch.setattr(lab.app.state.lti.messages, "clock", lambda: float(NOW))


@pytest.mark.usefixtures("messages")
@pytest.mark.parametrize(
    ("changed", "opens"),
    [
        ({"iat": NOW + 59}, True),
        ({"iat": NOW + 61}, False),
        ({"nbf": NOW + 59}, True),
        ({"nbf": NOW + 61}, False),
        ({"exp": NOW - 59}, True),
        ({"exp": NOW - 61}, False),
        ({"iat": NOW + 0.5, "exp": NOW + 300.5}, True),
        ({"iat": 10**400}, False),
        ({"exp": True}, False),
        ({"nbf": "soon"}, False),
    ],
)
def test_a_clock_may_differ_by_a_minute(browser: Browser, changed: dict[str, Any], opens: bool) -> None:
    answer = browser.launch(**{"iat": NOW, "exp": NOW + 300, **changed})
    assert answer.status_code == (303 if opens else 403), answer.text
    if not opens:
        assert next(iter(changed)) in answer.text or "expired" in answer.text


@pytest.mark.parametrize(
    ("changed", "opens"),
    [
        ({"aud": ["combbench"]}, True),
        ({"aud": ["combbench", "another tool"], "azp": "combbench"}, True),
        ({"aud": ["another tool", "combbench"], "azp": "combbench"}, True),
        ({"aud": ["another tool", "combbench"], "azp": "another tool"}, False),
        ({"aud": ["another tool", "a third"], "azp": "combbench"}, False),
        ({"aud": []}, False),
        ({f"{CLAIM}deployment_id": 1}, True),
        ({f"{CLAIM}deployment_id": 2}, False),
        ({f"{CLAIM}deployment_id": True}, False),
    ],
)
def test_of_several_tools_it_is_ours_and_a_deployment_may_be_a_number(
    browser: Browser, changed: dict[str, Any], opens: bool
) -> None:
    assert browser.launch(**changed).status_code == (303 if opens else 403)


def test_ids_that_are_numbers_are_no_other_persons_and_no_other_courses(lab: Live, browser: Browser) -> None:
    for sub, course in ((17, 1), (18, 1), (17, 2)):
        browser.session(sub=sub, **{f"{CLAIM}context": {"id": course, "title": f"Course {course}"}})
    classes = {one["name"]: one["students"] for one in lab.http.get("/api/v1/classes").json()["classes"]}
    assert classes == {"Course 1": 2, "Course 2": 1}
    assert browser.launch(sub=[17]).status_code == 403


OCT = {"kty": "oct", "k": "c2VjcmV0LW9mLXRoZS1wbGF0Zm9ybQ", "kid": KID}
EC = {**ECAlgorithm.to_jwk(ec.generate_private_key(ec.SECP256R1()).public_key(), as_dict=True), "kid": KID}


@pytest.mark.parametrize("beside", [[OCT], [EC], [OCT, EC, "no key", {}, {"kty": "RSA", "kid": KID, "use": "enc"}]])
def test_other_keys_may_stand_beside_ours(browser: Browser, beside: list[Any]) -> None:
    browser.platform.key_set = {"keys": [*beside, public_key(browser.platform.key)]}
    assert browser.launch().status_code == 303


@pytest.mark.parametrize(
    "key_set",
    [
        {},
        {"keys": {}},
        {"keys": []},
        [],
        "keys",
        {"keys": [OCT]},
        {"keys": [EC]},
        {"keys": [{"kty": "RSA", "kid": KID}]},
    ],
)
def test_a_platform_that_shows_no_key_is_to_blame(browser: Browser, key_set: Any) -> None:
    browser.platform.key_set = key_set
    answer = browser.launch()
    assert answer.status_code == 502 and "of the platform" in answer.text, answer.text


def test_keys_are_kept_and_a_new_one_is_asked_for_when_it_is_used(lab: Live, browser: Browser) -> None:
    platform, new = browser.platform, key_of("another id")

    def launched(key: Any, kid: str) -> int:
        browser.begin()
        return browser.end(platform.sign(platform.claims(browser.asked["nonce"]), key, kid)).status_code

    asked = platform.asked
    assert [launched(platform.key, KID) for _ in range(3)] == [303] * 3 and platform.asked == asked + 1
    platform.key_set = {"keys": [public_key(new, "new")]}
    assert launched(new, "new") == 403  # it has just been asked
    lab.advance(seconds=AGAIN_S)
    assert [launched(new, "new"), launched(platform.key, KID)] == [303, 403] and platform.asked == asked + 2
    lab.advance(seconds=KEPT_S)
    assert launched(new, "new") == 303 and platform.asked == asked + 3


def test_launches_that_wait_for_keys_hold_up_nobody_else(lab: Live, browser: Browser) -> None:
    platform = browser.platform
    platform.shows_keys.clear()
    browsers = [Browser(lab, platform) for _ in range(14)]
    asked = platform.asked
    with ThreadPoolExecutor(14) as threads:
        waiting = [threads.submit(one.launch) for one in browsers]
        lab.wait(lambda: platform.asked > asked)
        made = lab.bench("first-look", paused=True)["id"]
        assert lab.http.delete(f"/api/v1/benches/{made}").status_code == 204
        assert not any(one.done() for one in waiting) and platform.asked == asked + 1
        platform.shows_keys.set()
        assert {one.result().status_code for one in waiting} == {303}


STRANGE: list[Any] = [None, 0, -1, 1.5, True, "", "x", "\x00\u202e", [], ["x"], {}, {"id": 5}, [[]], "x" * 5000, 10**30]


def changed_once(claims: dict[str, Any], chance: random.Random) -> dict[str, Any]:
    """Return a message in which one field is another or missing, at any depth."""
    claims = {**claims}
    name = chance.choice(sorted(claims))
    if isinstance(claims[name], dict) and claims[name] and chance.random() < 0.5:
        claims[name] = changed_once(claims[name], chance)
    elif chance.random() < 0.15:
        del claims[name]
    else:
        claims[name] = chance.choice(STRANGE)
    return claims


@pytest.mark.parametrize("count", [40, pytest.param(200, marks=pytest.mark.long)])
def test_no_message_that_is_off_by_one_field_makes_the_server_fail(lab: Live, browser: Browser, count: int) -> None:
    chance, codes = random.Random(8), set()
    for number in range(count):
        browser.begin()
        platform, nonce = browser.platform, browser.asked["nonce"]
        good = platform.choice(nonce) if number % 3 == 0 else platform.claims(nonce)
        claims = changed_once(good, chance)
        answer = browser.end(platform.sign(claims))
        codes.add(answer.status_code)
        assert answer.status_code in (200, 303, 403), (claims, answer.text)
        if answer.status_code == 303:
            exchanged = browser.exchange(answer)
            assert exchanged.status_code in (200, 404, 422), (claims, exchanged.text)
        elif "name='code'" in answer.text:
            code = answer.text.partition("name='code' value='")[2].partition("'")[0]
            with lab.anonymous(headers={"Origin": lab.address}) as client:
                sent = client.post("/lti/link", data={"code": code, "choice": "sheet:first-look"})
            assert sent.status_code in (200, 403), (claims, sent.text)
    assert codes == {200, 303, 403}
    assert DEEP_LINKING in platform.choice("") and GRADES in platform.claims("")
