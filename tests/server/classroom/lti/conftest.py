"""Two learning platforms, and a server that knows both."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.server.classroom.lti.browser import Browser
from tests.server.classroom.lti.platform import Platform
from tests.server.conftest import Live, serving

FRAMES = ["https://moodle.example", "https://MOODLE.example:8443"]


@pytest.fixture(scope="session")
def platforms() -> Iterator[tuple[Platform, Platform]]:
    with Platform() as one, Platform("another id") as other:
        yield one, other


@pytest.fixture(scope="session")
def lab(tmp_path_factory: pytest.TempPathFactory, platforms: tuple[Platform, Platform]) -> Iterator[Live]:
    """The server; it sends each score at once."""
    lti = [{**platforms[0].settings, "frames": FRAMES}, platforms[1].settings]
    with serving(tmp_path_factory.mktemp("lti"), lti=lti, clock="manual") as live:
        scores = live.app.state.lti.scores
        scores._quiet_s = scores._first_wait_s = 0.0
        yield live


@pytest.fixture
def browser(lab: Live, platforms: tuple[Platform, Platform], monkeypatch: pytest.MonkeyPatch) -> Iterator[Browser]:
    """A browser at the first platform; the classes of its launches end with the test."""
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    platforms[0].scores.clear()
    yield Browser(lab, platforms[0])
    platforms[0].key_set = None
    lab.app.state.lti.key_sets._known.clear()
    lab.app.state.lti.tries._buckets.clear()
    for group in lab.http.get("/api/v1/classes").json()["classes"]:
        lab.http.delete(f"/api/v1/classes/{group['id']}")
