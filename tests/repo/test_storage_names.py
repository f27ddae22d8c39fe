"""What a browser keeps for the page has a name with the path of its server."""

from __future__ import annotations

import re
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2] / "web" / "src"
OTHERS = ("combbench.lti.", "combbench.session.", "combbench.v")
"""A launch, whose name ends in a random word that the server chose; protocols of a stream."""


def test_every_name_in_the_storage_of_the_browser_has_the_path_of_its_server() -> None:
    found = []
    for path in SOURCE.rglob("*.ts*"):
        if ".test." in path.name or "testing" in path.parts:
            continue
        text = path.read_text("utf-8")
        named = re.findall(r'(storageName\()?["`](combbench\.[\w.]*)', text)
        found += [(path.name, name, bool(marked)) for marked, name in named if name not in OTHERS]
        if "localStorage" in text or "sessionStorage" in text:
            assert re.search(r'["`]combbench\.', text) or path.name == "setup.ts", path
    assert len(found) > 10
    assert [one for one in found if not one[2]] == []
