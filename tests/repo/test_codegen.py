"""Generated files are current: `make codegen` would change nothing."""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from server import openapi


@pytest.fixture(scope="module")
def is_same(root: Path) -> Callable[[Any, Any], bool]:
    spec = importlib.util.spec_from_file_location("same_answer", root / "scripts" / "same_answer.py")
    assert spec is not None and spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    found: Callable[[Any, Any], bool] = script.is_same
    return found


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


def test_recorded_answers_are_current(root: Path, tmp_path: Path, is_same: Callable[[Any, Any], bool]) -> None:
    command = [sys.executable, root / "scripts" / "record_answers.py", tmp_path]
    subprocess.run(command, cwd=root, env={**os.environ, "PYTHONPATH": str(root)}, capture_output=True, check=True)
    made, kept = (
        {path.name: json.loads(path.read_bytes()) for path in folder.glob("*.json")}
        for folder in (tmp_path, root / "web" / "src" / "testing" / "recorded")
    )
    assert made.keys() == kept.keys(), "run make codegen"
    for name, content in made.items():
        assert is_same(content, kept[name]), f"{name}: run make codegen"


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ({"f0_hz": 1731.328969317808}, {"f0_hz": 1731.3289693181543}, True),
        ({"f0_hz": 1731.32}, {"f0_hz": 1731.33}, False),
        ({"a": 1, "b": 2}, {"b": 2, "a": 1}, False),
        ([1.0, 2.0], [1.0], False),
        ([1], [True], False),
        ([0], [0.0], False),
        (["m+5"], ["m+10"], False),
    ],
)
def test_answers_differ_by_more_than_the_last_digits(
    one: Any, other: Any, same: bool, is_same: Callable[[Any, Any], bool]
) -> None:
    assert is_same(one, other) is same
