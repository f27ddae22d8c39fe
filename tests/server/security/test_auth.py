"""Every route needs the token, but those listed with a reason."""

from __future__ import annotations

from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from server.stream.wire import SUBPROTOCOL

OPEN = {
    ("GET", "/health/live"): (200, "a container's health check has no token; it tells only which parts are well"),
    ("GET", "/health/ready"): (200, "the same"),
    ("GET", "/join"): (200, "the page that asks for the code of a class"),
    ("POST", "/join"): (403, "the code of a class opens it"),
    ("POST", "/api/v1/classes/class_id/join"): (422, "the same for programs"),
    ("GET", "/api/v1/schemas"): (200, "editors have no token; the schemas tell only the fields of documents"),
    ("GET", "/api/v1/schemas/name"): (404, "the same"),
    ("GET", "/watch/secret"): (403, "the link itself is the secret"),
    ("GET", "/watch"): (422, "a shared link, by which the teacher lets people watch"),
}
"""Doors that need no token, the answer to a stranger there, and the reason."""


def test_every_route_refuses_a_stranger(live: Any) -> None:
    checked = set()
    with live.anonymous() as stranger:
        for route in live.app.routes:
            if not getattr(route, "methods", None):
                continue  # a WebSocket: below
            path = route.path.replace("{", "").replace("}", "")
            for method in route.methods:
                headers = {"Origin": live.address}
                answer = stranger.request(method, path, headers=headers)
                checked.add((method, path))
                if (method, path) in OPEN:
                    assert answer.status_code == OPEN[method, path][0], path
                    continue
                assert answer.status_code == 401, (method, path)
                if method != "HEAD":
                    error = answer.json()["error"]
                    assert error["code"] == "unauthorised" and "token" in error["message"]
    assert len(checked) > 30
    assert set(OPEN) <= checked


def test_paths_that_are_no_route_refuse_a_stranger_too(live: Any) -> None:
    paths = ["/", "/some/page", "/api/v1/nothing", "/assets/x.js", "/metrics"]
    with live.anonymous() as stranger:
        assert [path for path in paths if stranger.get(path).status_code != 401] == []


def test_the_refusal_tells_a_person_what_this_is_and_how_to_get_in(live: Any) -> None:
    html = {"Accept": "text/html"}
    with live.anonymous() as stranger:
        answer = stranger.get("/?scenario=first-look&a=%22%3E%3Cb%3E", headers=html)
        wrong = stranger.get("/?token=%3Cscript%3E", headers=html)
    assert answer.status_code == wrong.status_code == 401
    assert "<main>" in answer.text and answer.text.endswith("</main>\n")
    assert "comb resonators" in answer.text and "Ask the person who runs it" in answer.text
    assert '<input type="hidden" name="scenario" value="first-look">' in answer.text
    assert 'value="&quot;&gt;&lt;b&gt;"' in answer.text and "<b>" not in answer.text
    assert answer.headers["content-type"].startswith("text/html")
    assert "not the one of this bench" in wrong.text and "not the one of this bench" not in answer.text
    assert "script" not in wrong.text


@pytest.mark.parametrize("headers", [{}, {"Authorization": "Bearer wrong"}, {"Cookie": "{cookie}=wrong"}])
def test_every_socket_refuses_a_stranger(live: Any, headers: dict[str, str]) -> None:
    cookie, base = live.app.state.identity.cookie_name, live.address.replace("http", "ws")
    given = {name: value.format(cookie=cookie) for name, value in headers.items()}
    for path in ("/api/v1/benches/x/stream", "/benches/x/3d", "/nothing"):
        options = {"origin": live.address, "additional_headers": given, "subprotocols": [SUBPROTOCOL], "proxy": None}
        with connect(base + path, **options) as socket, pytest.raises(ConnectionClosed) as caught:
            socket.recv(timeout=60)
        assert caught.value.rcvd is not None and caught.value.rcvd.code == 4401, path


def test_the_token_in_the_address_is_exchanged_for_a_cookie(live: Any) -> None:
    token = live.app.state.identity.token
    with live.anonymous() as browser:
        answer = browser.get(f"/some/page?a=1&token={token}&b=2")
        assert answer.status_code == 303
        assert answer.headers["location"] == "/some/page?a=1&b=2"
        cookie = answer.headers["set-cookie"]
        assert "HttpOnly" in cookie and "SameSite=strict" in cookie and token not in cookie
        assert browser.get("/api/v1/benches").status_code == 200
        # With the cookie alone nothing can be changed from elsewhere.
        assert browser.post("/api/v1/benches", json={"scenario": "x"}).status_code == 403
        same = {"Origin": live.address}
        assert browser.post("/api/v1/benches", json={"scenario": "x"}, headers=same).status_code == 422


def test_the_token_leaves_the_address_of_who_is_known_already_too(live: Any) -> None:
    link = f"/?bench=x&token={live.app.state.identity.token}"
    with live.anonymous() as browser:
        for _ in range(2):
            answer = browser.get(link)
            assert (answer.status_code, answer.headers["location"]) == (303, "/?bench=x")


def test_two_benches_on_one_host_do_not_log_each_other_out(live: Any, serve: Any) -> None:
    """A browser sends the cookies of a host to all its ports."""
    with serve(token="another-token-for-the-tests") as other, live.anonymous() as browser:
        for bench in (live, other, live):
            browser.get(f"{bench.address}/?token={bench.app.state.identity.token}")
        assert [browser.get(f"{bench.address}/api/v1/benches").status_code for bench in (live, other)] == [200, 200]
        assert len(browser.cookies) == 2


def test_a_link_on_another_site_gets_in_by_a_page_of_ours(live: Any) -> None:
    """A strict cookie is not sent along a redirect that began elsewhere."""
    token = live.app.state.identity.token
    with live.anonymous() as browser:
        answer = browser.get(f"/?token={token}", headers={"Sec-Fetch-Site": "cross-site"})
        assert answer.status_code == 200 and "url=/" in answer.text and token not in answer.text


def test_the_exchange_never_leads_elsewhere(live: Any) -> None:
    with live.anonymous() as browser:
        for path in ("//evil.example", "/\\evil.example", "/%5Cevil.example", "///evil.example/a"):
            answer = browser.get(f"{live.address}{path}?token={live.app.state.identity.token}")
            target = answer.headers.get("location", "/")
            assert target.startswith("/") and not target.startswith(("//", "/\\")), path


def test_a_wrong_token_gets_nothing(live: Any) -> None:
    with live.anonymous() as stranger:
        for token in ("wrong", "a-token-for-the-tests-onl", "ä", "a-token-for-the-tests-only2"):
            assert stranger.get("/", params={"token": token}).status_code == 401, token
            header = {"Authorization": f"Bearer {token}".encode()}
            assert stranger.get("/api/v1/benches", headers=header).status_code == 401, token


def test_the_3d_page_is_behind_the_gate(live: Any) -> None:
    bench = live.bench()
    url = live.address.replace("http", "ws") + f"/benches/{bench['id']}/3d"
    with live.anonymous() as stranger:
        assert stranger.get(f"/benches/{bench['id']}/3d/").status_code == 401
    with pytest.raises(InvalidStatus) as caught, connect(url, origin="http://evil.example", proxy=None):
        pass
    assert caught.value.response.status_code == 403
