"""HEAD: what answers GET answers it too, with the same headers and no body."""

from __future__ import annotations

import pytest

from tests.server.conftest import Live

PATHS = (
    "/health/live",
    "/health/ready",
    "/api/v1/me",
    "/api/v1/scenarios",
    "/api/v1/openapi.json",
    "/metrics",
    "/join",
)


@pytest.mark.parametrize("path", PATHS)
def test_head_is_answered_as_get_without_the_body(live: Live, path: str) -> None:
    whole, head = live.http.get(path), live.http.head(path)
    assert head.status_code == whole.status_code == 200 and head.content == b""
    assert head.headers["content-type"] == whole.headers["content-type"] and int(head.headers["content-length"]) > 0


def test_head_opens_no_door_that_get_does_not(live: Live) -> None:
    with live.anonymous() as stranger:
        assert stranger.head("/health/live").status_code == 200
        assert stranger.head("/api/v1/me").status_code == 401
    assert live.http.head("/api/v1/benches/no-such").status_code == 404
    assert live.http.head("/api/v1/runs/remove").status_code in (404, 405)
