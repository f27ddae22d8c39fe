"""The lists of claims name scenarios that are there, and every scenario of their chapters."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from scenarios.library import ids

CHAPTERS = {"claims-5.md": "ch5-"}


@pytest.mark.parametrize("name", CHAPTERS)
def test_claims_and_library_name_the_same(name: str, root: Path) -> None:
    named = set(re.findall(r"`((?:ch\d|app[A-Z]|gyro)-[a-z0-9-]+)`", (root / "docs" / name).read_text("utf-8")))
    assert named <= set(ids()), "scenarios that are not there"
    assert {one for one in ids() if one.startswith(CHAPTERS[name])} <= named, "scenarios without a claim"


@pytest.mark.parametrize("name", CHAPTERS)
def test_every_claim_has_a_scenario_or_a_reason(name: str, root: Path) -> None:
    rows = [line.split("|") for line in (root / "docs" / name).read_text("utf-8").splitlines() if line.startswith("| ")]
    empty = [row[1] for row in rows if row[1].strip() != "where" and not re.search(r"`ch5-|none: ", row[3])]
    assert empty == []
