"""The two suites, and settings every test shares.

The short suite is every test that is neither marked ``long`` nor in a folder of that name; ``--long`` runs all.
"""

from __future__ import annotations

import os
import random
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

# Matrices here are small: more threads only wait for one another, and their waiting is processor time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)

pytest_plugins = ["tests.budget"]

# The short suite tries the same examples every time, so that a failure comes again; the long one draws others.
SHORT = settings(
    derandomize=True,
    deadline=None,
    max_examples=25,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile("short", SHORT)
settings.register_profile("long", SHORT, derandomize=False, print_blob=True)
settings.load_profile("short")

DRAWN = int(os.environ.get("COMBBENCH_TEST_SEED", "0")) or random.SystemRandom().randrange(1, 10**9)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Offer the long suite."""
    parser.addoption("--long", action="store_true", help="run the long suite too")


def pytest_configure(config: pytest.Config) -> None:
    """Let the long suite draw its examples."""
    if config.getoption("--long"):
        settings.load_profile("long")


def pytest_report_header(config: pytest.Config) -> str | None:
    """Print the seed that the long suite draws from: given again, it repeats the session."""
    return f"COMBBENCH_TEST_SEED={seed_of(config)}" if config.getoption("--long") else None


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node: Any) -> None:
    """Give the seed to a process of xdist."""
    node.workerinput["test_seed"] = DRAWN


def seed_of(config: pytest.Config) -> int:
    """Return the seed of the session, the same in all its processes."""
    return int(getattr(config, "workerinput", {}).get("test_seed", DRAWN))


@pytest.fixture(scope="session")
def drawn_seed(request: pytest.FixtureRequest) -> int:
    """A seed for tests of the long suite, drawn for each session and printed."""
    return seed_of(request.config)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave the long suite out unless it is asked for."""
    for item in items:
        if "long" in Path(item.path).parts:
            item.add_marker(pytest.mark.long)
    if not config.getoption("--long"):
        left_out = [item for item in items if item.get_closest_marker("long")]
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if not item.get_closest_marker("long")]
