"""Behind nginx with TLS, as the documents set it up: HTTP, streams and the 3D view, at the root and below a path."""

from __future__ import annotations

import re
import socket
import ssl
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from tests.server.conftest import SUBPROTOCOL, serving
from tests.server.nginx import NAME, nginx

pytestmark = pytest.mark.long  # and the page has to be built


class Lab:
    """A service, nginx in front of it, and a browser's way to both."""

    def __init__(self, live: Any, folder: Path, port: int, prefix: str) -> None:
        self.live, self.folder, self.port, self.prefix = live, folder, port, prefix
        self.origin = f"https://{NAME}:{port}"
        self.context = ssl.create_default_context(cafile=str(folder / f"{NAME}.pem"))
        self.link = f"{self.origin}{prefix}/?token={live.app.state.identity.token}"

    @contextmanager
    def browser(self) -> Iterator[httpx.Client]:
        """Something that keeps cookies and finds the name here."""
        transport = Here(self.port, verify=self.context, trust_env=False)
        with httpx.Client(transport=transport, base_url=self.origin + self.prefix, timeout=30) as client:
            yield client

    def socket(self, path: str, cookies: Any, origin: str | None = None, protocol: str = SUBPROTOCOL) -> Any:
        """A WebSocket as a page would open it."""
        return connect(
            f"wss://{NAME}:{self.port}{self.prefix}{path}",
            sock=socket.create_connection(("127.0.0.1", self.port)),
            ssl=self.context,
            origin=origin or self.origin,  # type: ignore[arg-type]
            additional_headers={"Cookie": "; ".join(f"{name}={value}" for name, value in cookies.items())},
            subprotocols=[protocol],  # type: ignore[list-item]
            proxy=None,
            max_size=None,
        )


class Here(httpx.HTTPTransport):
    """Finds every name on this machine; certificates are checked all the same."""

    def __init__(self, port: int, **options: Any) -> None:
        super().__init__(**options)
        self._port = port

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        here = request.url.copy_with(host="127.0.0.1", port=self._port)
        extensions = {**request.extensions, "sni_hostname": request.url.host}
        sent = httpx.Request(
            request.method, here, headers=request.headers, stream=request.stream, extensions=extensions
        )
        return super().handle_request(sent)


@pytest.fixture(scope="module", params=["", "/bench"], ids=["root", "path"])
def lab(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Lab]:
    free = socket.create_server(("127.0.0.1", 0))  # kept until nginx takes its port
    port = free.getsockname()[1]
    public = f"https://{NAME}:{port}{request.param}"
    with serving(tmp_path_factory.mktemp("proxied"), public_origin=public) as live:
        free.close()
        with nginx(port, {request.param: live.http.base_url.port}) as folder:
            yield Lab(live, folder, port, request.param)


def test_the_printed_address_lets_in_by_tls_alone(lab: Lab) -> None:
    with lab.browser() as browser:
        assert browser.get("/api/v1/benches").status_code == 401
        answer = browser.get(lab.link)
        assert (answer.status_code, answer.headers["location"]) == (303, f"{lab.prefix}/")
        cookie = answer.headers["set-cookie"]
        assert "Secure" in cookie and f"Path={lab.prefix}/" in cookie
        assert cookie.startswith("__Secure-" if lab.prefix else "__Host-")
        page = browser.get("/")
        assert page.status_code == 200 and "max-age" in page.headers["strict-transport-security"]
        assert browser.get("/api/v1/benches").json() == {"benches": []}
        lost = browser.get("/some/page?a=1", headers={"Accept": "text/html"})
        assert lost.status_code == 404 and f'<base href="{lab.prefix}/"' in lost.text  # the page says so
    assert "token=" not in (lab.folder / "combbench.log").read_text()


def test_everything_the_page_loads_is_below_its_own_address(lab: Lab) -> None:
    with lab.browser() as browser:
        browser.get(lab.link)
        page = browser.get("/").text
        loaded = re.findall(r'<(?:script|link)[^>]* (?:src|href)="([^"]+)"', page)
        assert len(loaded) > 5
        for name in loaded:
            answer = browser.get(httpx.URL(f"{lab.origin}{lab.prefix}/").join(name))
            assert answer.status_code == 200 and "text/html" not in answer.headers["content-type"], name


def test_only_pages_of_the_public_origin_may_change_anything(lab: Lab) -> None:
    with lab.browser() as browser:
        browser.get(lab.link)
        body = {"scenario": "first-look", "paused": True}
        for origin in (
            "https://evil.example",
            f"https://{NAME}",
            f"http://{NAME}:{lab.port}",
            lab.live.address,
            "null",
        ):
            answer = browser.post("/api/v1/benches", json=body, headers={"Origin": origin})
            assert answer.status_code == 403 and answer.json()["error"]["code"] == "forbidden_origin", origin
        answer = browser.post("/api/v1/benches", json=body, headers={"Origin": lab.origin})
        assert answer.status_code == 201
        bench = answer.json()["id"]
        with pytest.raises(InvalidStatus) as caught:
            lab.socket(f"/api/v1/benches/{bench}/stream", browser.cookies, origin="https://evil.example")
        assert caught.value.response.status_code == 403
        assert browser.delete(f"/api/v1/benches/{bench}", headers={"Origin": lab.origin}).status_code == 204


def test_the_stream_and_the_3d_view_come_through(lab: Lab) -> None:
    with lab.browser() as browser:
        browser.get(lab.link)
        body = {"scenario": "first-look", "time_scale": 0.002}
        bench = browser.post("/api/v1/benches", json=body, headers={"Origin": lab.origin}).json()
        with lab.socket(f"/api/v1/benches/{bench['id']}/stream", browser.cookies) as stream:
            assert '"type":"hello"' in stream.recv(timeout=60)
        page = browser.get(bench["view3d"])
        assert page.status_code == 200 and "frame-ancestors 'self'" in page.headers["content-security-policy"]
        watch = f"/benches/{bench['id']}/3d"
        with lab.socket(watch, browser.cookies, protocol="viser-v1.1.1") as scene:
            assert all(isinstance(scene.recv(timeout=60), bytes) for _ in range(30))
        with pytest.raises(InvalidStatus):
            lab.socket(watch, browser.cookies, origin="https://evil.example", protocol="viser-v1.1.1")


def test_health_and_scripts_on_the_machine_need_no_proxy(lab: Lab) -> None:
    with lab.live.anonymous() as stranger:
        assert stranger.get("/health/ready").status_code == 200
    assert lab.live.http.post("/api/v1/benches/x/fork", json={}).status_code == 404
