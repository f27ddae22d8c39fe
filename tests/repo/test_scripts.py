"""The shell scripts can be run, and the Dockerfile copies only existing files."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest


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


def test_image_lets_its_user_read_all_kernels_that_its_build_compiles(root: Path) -> None:
    """Kernels are for their owner alone, and the service has another user."""
    build = (root / "Dockerfile").read_text()
    readable = build.index("chmod -R a+rX kernels")
    assert all(build.rindex(step) < readable for step in ("-m scenarios.kernels", "-m server.runs.figures"))


def test_makefile_and_dockerfile_run_scripts_that_exist(root: Path) -> None:
    text = (root / "Makefile").read_text() + (root / "Dockerfile").read_text()
    named = set(re.findall(r"scripts/[\w.]+", text))
    assert len(named) >= 8
    assert not [name for name in named if not (root / name).exists()]


def run_alone(folder: Path, script: Path, **environment: str) -> str:
    """Run a script in a folder that has nothing else; return the one line in which it says why it fails."""
    (folder / "scripts").mkdir()
    copy = shutil.copy(script, folder / "scripts")
    path = {"PATH": "/usr/bin:/bin", **environment}
    ended = subprocess.run([copy], env=path, capture_output=True, text=True, check=False)
    assert ended.returncode == 1 and ended.stdout == ""
    (line,) = ended.stderr.splitlines()
    return line


def program(path: Path, text: str) -> str:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return str(path)


WITHOUT_VENV = f"""case "$2" in *ensurepip*) exit 1 ;; esac
exec {sys.executable} "$@"
"""
TOO_OLD = 'case "$1" in --version) echo Python 3.9.2 ;; *) exit 1 ;; esac'


def test_an_environment_that_cannot_be_made_names_the_package_of_debian(root: Path, tmp_path: Path) -> None:
    python = program(tmp_path / "python3", WITHOUT_VENV)
    major, minor = sys.version_info[:2]
    assert f"apt install python{major}.{minor}-venv" in run_alone(tmp_path, root / "scripts/venv", PYTHON=python)
    assert not (tmp_path / ".venv").exists()


@pytest.mark.parametrize("text", [TOO_OLD, ""])
def test_a_python_that_is_too_old_or_missing_is_named(root: Path, tmp_path: Path, text: str) -> None:
    python = program(tmp_path / "python3", text) if text else "python-of-nobody"
    found = "Python 3.9.2" if text else "no python-of-nobody"
    line = run_alone(tmp_path, root / "scripts/venv", PYTHON=python)
    assert f"needs Python 3.11 to 3.14, and finds {found}." in line


def test_npm_without_any_node_says_what_brings_one(root: Path, tmp_path: Path) -> None:
    program(tmp_path / ".venv/bin/python", "echo a traceback >&2; exit 1")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/dirname").symlink_to(shutil.which("dirname") or "")
    line = run_alone(tmp_path, root / "scripts/npm", PATH=str(tmp_path / "bin"))
    assert "Node 22.12" in line and "make setup" in line
