"""A browser that is launched: it keeps the secret of the launch, as the page does."""

from __future__ import annotations

import re
from html import unescape
from typing import Any
from urllib.parse import parse_qs, parse_qsl, urlsplit

import httpx

from tests.server.classroom.lti.platform import Platform
from tests.server.conftest import Live


class Browser:
    """A launch, step by step."""

    def __init__(self, live: Live, platform: Platform) -> None:
        self.live, self.platform = live, platform
        self.asked: dict[str, str] = {}
        self.secret = ""

    def begin(self, **given: str) -> httpx.Response:
        """Come from the course."""
        asked = {"iss": self.platform.url, "login_hint": "17", "target_link_uri": "x", **given}
        with self.live.anonymous(headers={"Origin": self.platform.url}) as client:
            answer = client.post("/lti/login", data=asked)
        if answer.status_code == 200:
            found = dict(re.findall(r"data-(\w+)='([^']*)'", answer.text))
            self.secret = found["secret"]
            self.asked = dict(parse_qsl(urlsplit(unescape(found["to"])).query))
            assert unescape(found["name"]).endswith(self.asked["state"])
        return answer

    def end(self, message: str, state: str | None = None) -> httpx.Response:
        """Bring the signed message of the platform."""
        form = {"id_token": message, "state": self.asked["state"] if state is None else state}
        with self.live.anonymous(headers={"Origin": self.platform.url}) as client:
            return client.post("/lti/launch", data=form)

    def exchange(self, answer: httpx.Response, framed: bool = True, **changed: Any) -> httpx.Response:
        """Exchange the code in the address for a session."""
        where = parse_qs(urlsplit(answer.headers["location"]).fragment)
        body = {"code": where["launch"][0], "browser": self.secret, "framed": framed, **changed}
        with self.live.anonymous(headers={"Origin": self.live.address}) as client:
            return client.post("/lti/session", json=body)

    def launch(self, **claims: Any) -> httpx.Response:
        """Come, and bring the signed message of the platform."""
        assert self.begin().status_code == 200
        return self.end(self.platform.sign(self.platform.claims(self.asked["nonce"], **claims)))

    def session(self, **claims: Any) -> str:
        """Come all the way as a page in a frame; return the secret of the session."""
        answer = self.exchange(self.launch(**claims))
        assert answer.status_code == 200, answer.text
        return str(answer.json()["session"])
