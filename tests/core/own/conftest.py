"""Shared fixtures of the tests of user units."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.core.own.installed import Installed


@pytest.fixture(scope="session")
def python_where_it_is_installed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Installed]:
    """The template of a package, and a Python that answers where it is installed."""
    made = Installed(tmp_path_factory.mktemp("installed"))
    yield made
    made.end()


@pytest.fixture
def installed(python_where_it_is_installed: Installed) -> Installed:
    """The template of a package as it comes."""
    python_where_it_is_installed.renew()
    return python_where_it_is_installed
