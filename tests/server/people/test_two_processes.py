"""Two services behind one proxy: classes of each, students of both at once, and nobody in the other's."""

from __future__ import annotations

import contextlib
import socket
import ssl
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.server.conftest import serving
from tests.server.nginx import NAME, nginx
from tests.server.people.group import open_class
from tests.server.security.test_proxy import Here

pytestmark = pytest.mark.long
PREFIXES = "/a", "/b"


def test_a_second_service_takes_classes_of_its_own(tmp_path: Path) -> None:
    free = socket.create_server(("127.0.0.1", 0))  # kept until nginx takes its port
    port = free.getsockname()[1]
    origin = f"https://{NAME}:{port}"
    with contextlib.ExitStack() as stack:
        services = [
            stack.enter_context(serving(tmp_path / prefix[1:], public_origin=f"{origin}{prefix}"))
            for prefix in PREFIXES
        ]
        ports = {prefix: one.http.base_url.port for prefix, one in zip(PREFIXES, services, strict=True)}
        free.close()
        folder = stack.enter_context(nginx(port, ports))
        context = ssl.create_default_context(cafile=str(folder / f"{NAME}.pem"))

        def browser(prefix: str) -> httpx.Client:
            transport = Here(port, verify=context, trust_env=False)
            base = {"base_url": origin + prefix, "headers": {"Origin": origin}, "timeout": 30}
            return stack.enter_context(httpx.Client(transport=transport, **base))

        def joined(prefix: str, group: dict[str, Any], name: str) -> httpx.Client:
            client = browser(prefix)
            assert client.get("/").status_code == 401
            sent = client.post("/join", data={"code": group["code"], "name": name})
            assert sent.status_code == 303 and sent.headers["location"] == f"{prefix}/"
            return client

        groups = [open_class(one, f"Class of {prefix}") for prefix, one in zip(PREFIXES, services, strict=True)]
        assert all(origin + prefix in group["addresses"][0] for prefix, group in zip(PREFIXES, groups, strict=True))
        pupils = [joined(prefix, group, "Ada") for prefix, group in zip(PREFIXES, groups, strict=True)]
        benches = [client.get("/api/v1/me").json()["bench"] for client in pupils]
        for client, bench, other in zip(pupils, benches, benches[::-1], strict=True):
            assert client.get(f"/api/v1/benches/{bench}").json()["state"] == "running"
            assert client.get(f"/api/v1/benches/{other}").status_code == 403
        # the code of one opens nothing at the other, and neither does a session
        refused = browser("/a").post("/join", data={"code": groups[1]["code"], "name": "Eve"})
        assert refused.status_code == 403
        stranger = browser("/b")
        stranger.cookies.update(pupils[0].cookies)
        assert stranger.get("/api/v1/me").status_code == 401
        # one that ends takes nothing of the other with it
        services[0].http.delete(f"/api/v1/classes/{groups[0]['id']}")
        assert pupils[0].get("/api/v1/me").status_code == 401
        assert pupils[1].get(f"/api/v1/benches/{benches[1]}").json()["state"] == "running"
