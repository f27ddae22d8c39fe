"""Classes under test: device time, leases and limits pass only when a test advances the clock."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from tests.server.conftest import Live, serving
from tests.server.people.group import open_class


@pytest.fixture(scope="session")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    """One server for all tests that leave it as they find it."""
    with serving(tmp_path_factory.mktemp("shared"), clock="manual") as live:
        yield live


@pytest.fixture
def live(live: Live) -> Live:
    """The shared server, at which nobody has tried a code yet."""
    live.service.joining._tries._buckets.clear()
    return live


@pytest.fixture
def group(live: Live) -> Iterator[dict[str, Any]]:
    """A class; the end of the test is the end of the class too."""
    made = open_class(live)
    yield made
    live.http.delete(f"/api/v1/classes/{made['id']}")
