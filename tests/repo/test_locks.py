"""The locks pin everything, and say nothing of where it was fetched."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path


def locked(root: Path) -> dict[str, str]:
    """Return the entries of requirements.lock by package name."""
    text = (root / "requirements.lock").read_text()
    entries = re.split(r"^(?=[a-z0-9])", text, flags=re.M)[1:]
    return {entry.split("==")[0]: entry for entry in entries}


def test_every_python_package_is_pinned_by_hash(root: Path) -> None:
    entries = locked(root)
    assert len(entries) > 50
    for name, entry in entries.items():
        assert re.match(r"[a-z0-9._-]+==[^ ]+ ", entry), name
        assert "--hash=sha256:" in entry, name


def test_lock_covers_the_project_file(root: Path) -> None:
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"].values()
    wanted = [*project["dependencies"], *(item for extra in extras for item in extra)]
    names = {re.split(r"[\[<>=;! ]", item)[0].lower() for item in wanted}
    assert names <= set(locked(root)), "run make lock"


def test_python_lock_names_no_place(root: Path) -> None:
    text = (root / "requirements.lock").read_text()
    assert "://" not in text
    assert not [line for line in text.splitlines() if re.match(r"\s*(-|/|\.)", line.split("--hash")[0])]


def test_npm_lock_names_no_place_and_has_every_hash(root: Path) -> None:
    packages = json.loads((root / "web" / "package-lock.json").read_text())["packages"]
    assert len(packages) > 50
    for name, package in packages.items():
        assert "resolved" not in package, name
        assert not name or package.get("link") or package.get("integrity"), name


def test_page_dependencies_are_exact(root: Path) -> None:
    package = json.loads((root / "web" / "package.json").read_text())
    for name, version in {**package["dependencies"], **package["devDependencies"]}.items():
        assert re.fullmatch(r"\d+\.\d+\.\d+", version), f"{name} {version}"
