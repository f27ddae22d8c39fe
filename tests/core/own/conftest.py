"""What tests of units of one's own share."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.core.own.installed import Installed


@pytest.fixture
def installed(tmp_path: Path) -> Installed:
    """Return what calls Python where the template of a package is installed."""
    return Installed(tmp_path)
