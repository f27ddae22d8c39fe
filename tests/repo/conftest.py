"""The repository as these tests see it: its root and the files that are, or would be, committed."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def root() -> Path:
    return ROOT


@pytest.fixture(scope="session")
def files() -> list[Path]:
    """Every tracked or new file, without ignored files."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    found = [ROOT / name for name in listed.split("\0") if name]
    return [path for path in found if path.is_file()]


@pytest.fixture(scope="session")
def documents() -> dict[str, str]:
    """The documents, by path: at the top of the repository, in `docs` and in `docs/design`."""
    paths = [path for place in ("*.md", "docs/*.md", "docs/design/*.md") for path in sorted(ROOT.glob(place))]
    return {path.relative_to(ROOT).as_posix(): path.read_text() for path in paths}
