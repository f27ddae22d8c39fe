"""Host and Origin, for HTTP and for WebSockets."""

from __future__ import annotations

import re
from base64 import b64encode
from hashlib import sha256
from typing import Any

import pytest
from websockets.exceptions import InvalidStatus

HOSTS = [
    ("127.0.0.1:{port}", True),
    ("localhost:{port}", True),
    ("LOCALHOST:{port}", True),
    ("[::1]:{port}", True),
    ("localhost", True),
    ("evil.example", False),
    ("evil.example:{port}", False),
    ("127.0.0.1.evil.example:{port}", False),
    ("localhost.evil.example", False),
    ("127.0.0.1@evil.example", False),
    ("evil.example#127.0.0.1", False),
    ("127.0.0.1:{port}/evil", False),
    ("127.0.0.1:port", False),
    ("", False),
]

ORIGINS = [
    ("http://127.0.0.1:{port}", True),
    ("https://127.0.0.1:{port}", False),
    ("http://127.0.0.1:1", False),
    ("http://127.0.0.1", False),
    ("http://localhost:{port}", False),  # ours, but not the one this page was opened under
    ("http://evil.example", False),
    ("http://127.0.0.1:{port}.evil.example", False),
    ("http://evil.example/127.0.0.1:{port}", False),
    ("HTTP://127.0.0.1:{port}", False),
    ("null", False),
    ("", False),
    ("file://", False),
]


def test_only_our_own_names_are_answered(live: Any) -> None:
    for host, welcome in HOSTS:
        given = host.format(port=live.http.base_url.port)
        answer = live.http.get("/api/v1/benches", headers={"Host": given})
        assert answer.status_code in ((200,) if welcome else (400, 403)), host
        assert answer.status_code != 403 or answer.json()["error"]["code"] == "forbidden_origin", host


@pytest.mark.parametrize("method", ["GET", "POST", "DELETE"])
def test_only_our_own_page_may_ask(live: Any, method: str) -> None:
    for origin, welcome in ORIGINS:
        given = origin.format(port=live.http.base_url.port)
        answer = live.http.request(method, "/api/v1/benches/none", headers={"Origin": given})
        assert answer.status_code in ((404, 405) if welcome else (403,)), origin
        assert welcome or answer.json()["error"]["code"] == "forbidden_origin", origin


def test_only_our_own_page_may_open_a_stream(live: Any) -> None:
    bench = live.bench(paused=True)["id"]
    for origin, welcome in ORIGINS:
        given = origin.format(port=live.http.base_url.port)
        if welcome:
            with live.stream(bench, origin=given) as stream:
                assert stream.step()["type"] == "hello"
            continue
        with pytest.raises(InvalidStatus) as caught, live.stream(bench, origin=given):
            pass
        assert caught.value.response.status_code == 403, origin


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example"])
def test_a_name_that_was_rebound_opens_no_stream(live: Any, host: str) -> None:
    bench = live.bench(paused=True)
    headers = {"Authorization": live.http.headers["authorization"], "Host": host}
    with (
        pytest.raises(InvalidStatus) as caught,
        live.stream(bench["id"], origin=f"http://{host}", additional_headers=headers),
    ):
        pass
    assert caught.value.response.status_code in (400, 403)


def test_a_program_with_the_token_needs_no_origin_and_a_cookie_does(live: Any) -> None:
    bench = live.bench(paused=True)
    with live.stream(bench["id"], origin=None) as stream:
        assert stream.step()["type"] == "hello"
    identity = live.app.state.identity
    cookie = {"Cookie": f"{identity.cookie_name}={identity.cookie}"}
    with pytest.raises(InvalidStatus), live.stream(bench["id"], origin=None, additional_headers=cookie):
        pass
    with live.stream(bench["id"], origin=live.address, additional_headers=cookie) as stream:
        assert stream.step()["type"] == "hello"


def test_a_name_given_in_the_settings_is_ours(serve: Any) -> None:
    with serve(allowed_hosts=["bench.example"]) as live:
        headers = {"Host": "bench.example", "Origin": "http://bench.example"}
        assert live.http.post("/api/v1/benches/x/fork", json={}, headers=headers).status_code == 404


def test_every_response_carries_the_security_headers(live: Any) -> None:
    bench = live.bench(paused=True)
    with live.anonymous() as stranger:
        answers = [
            live.http.get("/api/v1/benches"),
            live.http.get("/api/v1/nothing"),
            live.http.get("/"),
            live.http.post("/api/v1/benches", content=b"x" * (2 << 20)),
            stranger.get("/"),
            stranger.get("/", headers={"Host": "evil.example"}),
        ]
        stranger_page = stranger.get("/", headers={"Accept": "text/html"})
    for answer in answers:
        policy = answer.headers["content-security-policy"]
        assert "script-src 'self';" in policy and "frame-ancestors 'none'" in policy
        assert "unsafe-eval" not in policy
        elements = policy.partition("style-src-elem ")[2].partition(";")[0]
        assert "'self' 'nonce-" in elements and "unsafe-inline" not in elements
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert answer.headers["referrer-policy"] == "no-referrer"
    # each answer has a nonce of its own, which the page tells its libraries; the plain pages are known by their hash
    nonces = [re.findall(r"'nonce-([^']{16,})'", answer.headers["content-security-policy"]) for answer in answers]
    assert len({nonce for (nonce,) in nonces}) == len(answers)
    assert f'<meta name="nonce" content="{nonces[2][0]}">' in answers[2].text
    style = re.findall(r"<style>(.*?)</style>", stranger_page.text, re.DOTALL)[0]
    assert b64encode(sha256(style.encode()).digest()).decode() in stranger_page.headers["content-security-policy"]
    page = live.http.get(f"/benches/{bench['id']}/3d/")
    assert "frame-ancestors 'self'" in page.headers["content-security-policy"]
