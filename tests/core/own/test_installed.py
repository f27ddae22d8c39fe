"""Units of an installed package: the template of ``docs/template``, found by its entry point."""

from __future__ import annotations

import json
from pathlib import Path

from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.core.own.installed import TEMPLATE, Installed
from tests.core.own.test_own_units import with_unit

LEAD = {"controller.kind": "lead", "duration_ms": 5.0}


def test_an_installed_unit_is_in_the_catalogue_and_runs_as_its_text_does(installed: Installed) -> None:
    cards = installed("-m", "server.cli", "catalog", "control", "--json")
    card = next(one for one in json.loads(cards.stdout) if one["name"] == "lead")
    assert card["family"] == "control" and card["title"] == "Lead"
    assert [one["name"] for one in card["parameters"]] == ["gain_v_um", "time_ms", "ratio"]
    assignments = [word for name, value in LEAD.items() for word in ("--set", f"{name}={value}")]
    done = installed("-m", "server.cli", "run", "first-look", *assignments, "--json")
    ours = run(with_unit("lead", (TEMPLATE / "lead.py").read_text("utf-8"), LEAD, "first-look"))
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["digest"] == ours.digest
    assert ours.digest != run(with_values(get("first-look"), {"duration_ms": 5.0})).digest


def test_the_test_of_the_template_passes_where_it_is_installed(installed: Installed) -> None:
    folder = str(installed.source)
    done = installed("-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", folder, folder)
    assert done.returncode == 0, done.stdout
    assert "2 passed" in done.stdout


def test_a_package_that_cannot_be_loaded_is_named_in_one_line(installed: Installed, tmp_path: Path) -> None:
    info = tmp_path / "broken-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: broken\nVersion: 1.0\n", "utf-8")
    (info / "entry_points.txt").write_text("[combbench.control]\nnone = no_such_module:None\n", "utf-8")
    done = installed("-m", "server.cli", "catalog", "control")
    assert done.returncode == 2 and done.stdout == ""
    (line,) = done.stderr.strip().split("\n")
    assert line.startswith("combbench: combbench.control.none: broken names no_such_module:None")
