"""What is generated is what would be generated now: `make codegen` would change nothing."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


def test_openapi_document_is_current(root: Path) -> None:
    now = subprocess.run([sys.executable, "-m", "server.openapi"], cwd=root, capture_output=True, text=True, check=True)
    assert now.stdout == (root / "web" / "openapi.json").read_text(), "run make codegen"


def test_types_of_the_page_are_current(root: Path, tmp_path: Path) -> None:
    made = tmp_path / "schema.d.ts"
    command = ["scripts/npm", "--silent", "--prefix", "web", "run", "codegen", "--", "-o", str(made)]
    subprocess.run(command, cwd=root, check=True, capture_output=True)
    assert made.read_text() == (root / "web" / "src" / "api" / "schema.d.ts").read_text(), "run make codegen"
