"""Units of an installed package: the template of ``docs/template``, found by its entry point."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.core.own.test_own_units import with_unit
from tests.core.own.texts import ROOT

TEMPLATE = ROOT / "docs" / "template"
Told = Callable[..., subprocess.CompletedProcess[str]]
LEAD = {"controller.kind": "lead", "duration_ms": 5.0}


@pytest.fixture
def told(tmp_path: Path) -> Told:
    """Return what calls Python where the template is installed as ``pip install -e`` leaves it."""
    project = tomllib.loads((TEMPLATE / "pyproject.toml").read_text("utf-8"))["project"]
    name, version = project["name"], project["version"]
    info = tmp_path / f"{name.replace('-', '_')}-{version}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n", "utf-8")
    groups = [
        f"[{group}]\n" + "".join(f"{unit} = {where}\n" for unit, where in units.items())
        for group, units in project["entry-points"].items()
    ]
    (info / "entry_points.txt").write_text("\n".join(groups), "utf-8")
    found = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (tmp_path, TEMPLATE, ROOT)))}

    def call(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, *words]
        return subprocess.run(command, cwd=tmp_path, env=found, capture_output=True, text=True, check=False)

    return call


def test_an_installed_unit_is_in_the_catalogue_and_runs_as_its_text_does(told: Told) -> None:
    cards = told("-m", "server.cli", "catalog", "control", "--json")
    card = next(one for one in json.loads(cards.stdout) if one["name"] == "lead")
    assert card["family"] == "control" and card["title"] == "Lead"
    assert [one["name"] for one in card["parameters"]] == ["gain_v_um", "time_ms", "ratio"]
    assignments = [word for name, value in LEAD.items() for word in ("--set", f"{name}={value}")]
    done = told("-m", "server.cli", "run", "first-look", *assignments, "--json")
    ours = run(with_unit("lead", (TEMPLATE / "lead.py").read_text("utf-8"), LEAD, "first-look"))
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["digest"] == ours.digest
    assert ours.digest != run(with_values(get("first-look"), {"duration_ms": 5.0})).digest


def test_the_test_of_the_template_passes_where_it_is_installed(told: Told) -> None:
    done = told("-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", str(TEMPLATE), str(TEMPLATE))
    assert done.returncode == 0, done.stdout
    assert "2 passed" in done.stdout


def test_a_package_that_cannot_be_loaded_is_named_in_one_line(told: Told, tmp_path: Path) -> None:
    info = tmp_path / "broken-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: broken\nVersion: 1.0\n", "utf-8")
    (info / "entry_points.txt").write_text("[combbench.control]\nnone = no_such_module:None\n", "utf-8")
    done = told("-m", "server.cli", "catalog", "control")
    assert done.returncode == 2 and done.stdout == ""
    (line,) = done.stderr.strip().split("\n")
    assert line.startswith("combbench: combbench.control.none: broken names no_such_module:None")
