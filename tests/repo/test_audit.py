"""The audit of packages: a known weakness stops it, an index without knowledge is reported."""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path
from typing import Any

import pytest


@pytest.fixture
def audit(root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The script, with the answers of its commands in the given order."""
    spec = importlib.util.spec_from_file_location("audit_script", root / "scripts" / "audit.py")
    assert spec is not None and spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    monkeypatch.setattr(script.subprocess, "run", lambda *_command, **_named: None)

    def ask(kind: str, *answers: object) -> int:
        texts = iter([one if isinstance(one, str) else json.dumps(one) for one in answers])
        monkeypatch.setattr(script, "said", lambda *_command: next(texts))
        monkeypatch.setattr(sys, "argv", ["audit.py", kind, str(tmp_path)])
        code: int = script.main()
        return code

    return ask


WEAK = {"name": "old", "version": "1.0", "vulns": [{"id": "CVE-1", "fix_versions": ["1.1"]}]}
SOUND = {"name": "new", "version": "2.0", "vulns": []}
UNKNOWN = {"name": "own", "skip_reason": "not found"}


def test_a_known_weakness_is_an_error(audit: Any, capsys: pytest.CaptureFixture[str]) -> None:
    assert audit("python", "/place", {"dependencies": [WEAK, SOUND, UNKNOWN]}) == 1
    told = capsys.readouterr().out
    assert "3 packages, 2 of them known to the index, 1 known" in told and "old 1.0: CVE-1, mended in 1.1" in told
    assert audit("python", "/place", {"dependencies": [SOUND]}) == 0
    bill = {"components": [1, 2, 3]}
    assert audit("page", bill, {"vulnerabilities": {"old": {"severity": "high"}}}) == 1
    assert audit("page", bill, {"vulnerabilities": {}}) == 0


@pytest.mark.parametrize("answer", ["", "no JSON", {"message": "405"}, {"dependencies": [UNKNOWN]}])
def test_an_index_without_advisories_is_told_of(audit: Any, capsys: pytest.CaptureFixture[str], answer: object) -> None:
    assert audit("python", "/place", answer) == 0 and audit("page", {"components": [1]}, answer) == 0
    assert capsys.readouterr().out.count(" 0 of them known to the index") == 2
