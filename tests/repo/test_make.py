"""The Makefile keeps the targets people rely on, and the documents name no other."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

PROMISED = set("run classroom setup test help check fix dev bench load soak image codegen".split())


def targets(root: Path) -> dict[str, str]:
    rules = re.findall(r"^([a-z-]+):[^=\n]*?## (.*)$", (root / "Makefile").read_text(), re.M)
    return dict(rules)


def test_promised_targets_exist(root: Path) -> None:
    assert set(targets(root)) >= PROMISED


def test_help_lists_every_target_with_its_meaning(root: Path) -> None:
    shown = subprocess.run(["make", "help"], cwd=root, capture_output=True, text=True, check=True).stdout
    for name, meaning in targets(root).items():
        assert meaning, f"make {name} has no ## comment"
        assert re.search(rf"^  make {name} +{re.escape(meaning)}$", shown, re.M)


def test_a_class_is_served_as_everything_else_is(root: Path) -> None:
    for target, served in ("classroom", "serve --port 1 --classroom "), ("run", "serve --port 1 ||"):
        command = ["make", "-n", target, "ARGS=--port 1"]
        planned = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout
        assert f".venv/bin/combbench {served}" in planned


def test_python_keeps_its_bytecode_whatever_the_environment_says(root: Path) -> None:
    command = ["make", "-s", "--eval", "told: ; @env", "told"]
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "TOLD": "1"}
    told = subprocess.run(command, cwd=root, env=environment, capture_output=True, text=True, check=True).stdout
    assert "TOLD=1" in told.splitlines() and "BYTECODE" not in told


def test_documents_name_only_targets_that_exist(root: Path, documents: dict[str, str]) -> None:
    known = targets(root)
    for document, text in documents.items():
        code = " ; ".join(re.findall(r"```.*?```|`[^`\n]+`", text, re.S))
        named = set(re.findall(r"\bmake ([a-z-]+)", code))
        assert named <= set(known), f"{document} names {named - set(known)}"
    assert "`make run`" in documents["README.md"] or "make run\n" in documents["README.md"]


def test_ci_runs_everything(root: Path) -> None:
    script = root / ".ci" / "run"
    assert script.stat().st_mode & 0o111
    assert "exec make test" in script.read_text()
