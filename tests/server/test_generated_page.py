"""The page on generated clients is right: its commands and programs run unchanged, and they print what is beneath."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.server.conftest import TOKEN

ROOT = Path(__file__).resolve().parents[2]
FILES = {
    "Python": {"yaml": ["config.yaml"], "python": ["lab.py"]},
    "TypeScript": {
        "json": ["package.json", "tsconfig.json"],
        "js": ["openapi-ts.config.js"],
        "ts": ["lab.ts"],
    },
}
"""The files of each section, by the language of their blocks."""


def blocks(section: str) -> dict[str, list[str]]:
    """Return the blocks of a section of the page, by their language."""
    page = (ROOT / "docs" / "generated-clients.md").read_text()
    text = re.split(r"^## ", page.split(f"\n## {section}\n")[1], flags=re.M)[0]
    found: dict[str, list[str]] = {}
    for language, block in re.findall(r"^```(\w+)\n(.*?)^```", text, re.M | re.S):
        found.setdefault(language, []).append(block)
    return found


@pytest.fixture
def folder(live: Any, tmp_path: Path) -> Path:
    """A folder with the document that the server gives."""
    (tmp_path / "openapi.json").write_text(live.http.get("/api/v1/openapi.json").text)
    return tmp_path


def put(section: str, folder: Path) -> dict[str, list[str]]:
    """Write the files of a section; return its blocks."""
    found = blocks(section)
    assert found.keys() == {*FILES[section], "sh", "text"}
    for language, names in FILES[section].items():
        for name, text in zip(names, found[language], strict=True):
            (folder / name).write_text(text)
    return found


def carry_out(command: list[Any], live: Any, folder: Path) -> str:
    """Run a command in the folder; return what it prints."""
    own = {"COMBBENCH_ADDRESS": live.address, "COMBBENCH_TOKEN": TOKEN}
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    done = subprocess.run(command, cwd=folder, env={**os.environ, **own, "PATH": path}, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.long
def test_the_client_in_python(live: Any, folder: Path) -> None:
    found = put("Python", folder)
    carry_out(["sh", "-e", "-c", "\n".join(found["sh"])], live, folder)
    carry_out([sys.executable, "-m", "mypy", "--strict", "lab.py", "combbench_api"], live, folder)
    assert carry_out([sys.executable, "lab.py"], live, folder) == "".join(found["text"])


@pytest.mark.long
def test_the_client_in_typescript(live: Any, folder: Path) -> None:
    found = put("TypeScript", folder)
    (folder / "node_modules").symlink_to(ROOT / "web" / "node_modules")
    generate, program = (re.sub("^npx ", "", text, flags=re.M) for text in found["sh"])
    npm = [ROOT / "scripts" / "npm", "exec", "--call"]
    carry_out([*npm, f"set -e\n{generate}"], live, folder)
    assert carry_out([*npm, f"set -e\n{program}"], live, folder) == "".join(found["text"])
