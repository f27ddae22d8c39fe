"""Generated files are current: `make codegen` would change nothing."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from server import openapi


def test_openapi_document_is_current(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    openapi.main()
    assert capsys.readouterr().out == (root / "web" / "openapi.json").read_text(), "run make codegen"


def test_types_of_the_page_are_current(root: Path, tmp_path: Path) -> None:
    web = root / "web"
    command = json.loads((web / "package.json").read_text())["scripts"]["codegen"].split()
    kept, made = web / command[-1], tmp_path / "schema.d.ts"
    generate = [root / "scripts" / "npm", "--silent", "exec", "--", *command[:-1], made]
    subprocess.run(generate, cwd=web, check=True, capture_output=True)
    assert made.read_text() == kept.read_text(), "run make codegen"


def test_recorded_answers_are_current(root: Path, tmp_path: Path) -> None:
    command = [sys.executable, root / "scripts" / "record_answers.py", tmp_path]
    subprocess.run(command, cwd=root, env={**os.environ, "PYTHONPATH": str(root)}, capture_output=True, check=True)
    made, kept = (
        {path.name: path.read_bytes() for path in folder.glob("*.json")}
        for folder in (tmp_path, root / "web" / "src" / "testing" / "recorded")
    )
    assert made.keys() == kept.keys(), "run make codegen"
    for name, content in made.items():
        assert content == kept[name], f"{name}: run make codegen"
