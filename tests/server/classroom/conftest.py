"""Classes under test: device time, leases and limits pass only when a test advances the clock."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from tests.server.classroom.group import open_class
from tests.server.conftest import Live, serving
from tests.server.forks import forks


@pytest.fixture
def live(live: Live) -> Iterator[Live]:
    """The shared server; it forgets afterwards how often codes were tried."""
    yield live
    live.service.joining._tries._buckets.clear()


@pytest.fixture
def group(live: Live) -> Iterator[dict[str, Any]]:
    """A class; the end of the test is the end of the class too."""
    made = open_class(live)
    yield made
    live.http.delete(f"/api/v1/classes/{made['id']}")


@pytest.fixture
def servers(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[list[Any]]:
    """Two servers, one after the other: the second has the folder as the first leaves it.

    The first is stopped, or killed, or the folder is copied while it serves: a kill would leave the same.
    """
    folder, copy = tmp_path / "data", tmp_path / "copy"

    @contextmanager
    def copied() -> Iterator[Live]:
        with serving(folder) as live:
            yield live
            shutil.copytree(folder, copy)

    if request.param == "killed":
        with forks(tmp_path / "log") as loaded:
            yield [loaded.serve(folder, figures=False, clock="manual") for _ in "12"]
    elif request.param == "left":
        yield [copied(), serving(copy)]
    else:
        yield [serving(folder) for _ in "12"]
