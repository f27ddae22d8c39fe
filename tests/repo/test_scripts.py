"""The shell scripts can be run, and the Dockerfile copies only existing files."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path


def test_shell_scripts_parse_and_may_be_run(root: Path) -> None:
    scripts = [path for path in (root / "scripts").iterdir() if not path.suffix and path.is_file()]
    assert {"venv", "npm", "chromium", "image", "entrypoint"} <= {path.name for path in scripts}
    for path in scripts:
        assert path.read_text().startswith("#!/bin/sh\n"), path.name
        assert path.stat().st_mode & 0o111, path.name
        subprocess.run(["sh", "-n", path], check=True)


def test_image_copies_what_is_there_and_runs_without_root(root: Path) -> None:
    text = (root / "Dockerfile").read_text()
    sources = [name for line in re.findall(r"^COPY (?!--from)(.*)$", text, re.M) for name in line.split()[:-1]]
    assert sources
    assert not [name for name in sources if not (root / name).exists()]
    last_stage = text.rsplit("\nFROM ", 1)[1]
    assert re.search(r"^USER 10001:10001$", last_stage, re.M)
    assert re.search(r"^HEALTHCHECK ", last_stage, re.M)


def test_makefile_and_dockerfile_run_scripts_that_exist(root: Path) -> None:
    text = (root / "Makefile").read_text() + (root / "Dockerfile").read_text()
    named = set(re.findall(r"scripts/[\w.]+", text))
    assert len(named) >= 8
    assert not [name for name in named if not (root / name).exists()]
