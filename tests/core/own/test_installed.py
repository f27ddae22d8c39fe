"""Units of an installed package: the template of ``docs/template``, found by its entry point."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from core import registry
from core.board.packages import packages
from core.compile.numbers import NOTATION
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from server.cli.main import app
from tests.core.own.installed import TEMPLATE, Installed
from tests.core.own.test_own_units import with_unit

LEAD = {"controller.kind": "lead", "duration_ms": 5.0}
CALLED = """
import io, json
from contextlib import redirect_stdout
from server.cli.main import app
with redirect_stdout(io.StringIO()) as said:
    app(words, standalone_mode=False)
answer = json.loads(said.getvalue())
"""
TESTED = """
import test_lead
tests = [value for name, value in vars(test_lead).items() if name.startswith("test_")]
for test in tests:
    test()
answer = len(tests)
"""


def test_an_installed_unit_is_in_the_catalogue_and_runs_as_its_text_does(installed: Installed) -> None:
    card = next(one for one in installed.answer(CALLED, "catalog", "control", "--json") if one["name"] == "lead")
    assert card["family"] == "control" and card["title"] == "Lead"
    assert [one["name"] for one in card["parameters"]] == ["gain_v_um", "time_ms", "ratio"]
    assignments = [word for name, value in LEAD.items() for word in ("--set", f"{name}={value}")]
    done = installed.answer(CALLED, "run", "first-look", *assignments, "--json")
    ours = run(with_unit("lead", (TEMPLATE / "lead.py").read_text("utf-8"), LEAD, "first-look"))
    assert done["digest"] == ours.digest
    assert ours.digest != run(with_values(get("first-look"), {"duration_ms": 5.0})).digest


def test_the_test_of_the_template_passes_where_it_is_installed(installed: Installed) -> None:
    assert installed.answer(TESTED) == 2


def checked(installed: Installed, *words: str) -> subprocess.CompletedProcess[str]:
    """Ask the command line about the package, in a process that loads it anew."""
    command = [sys.executable, "-m", "server.cli.main", "check", *words]
    return subprocess.run(command, env=installed.environment, capture_output=True, text=True, check=False)


def test_an_installed_unit_is_checked_by_the_name_of_its_package(installed: Installed) -> None:
    ended = checked(installed, "combbench-lead", "--json")
    (row,) = json.loads(ended.stdout)
    assert ended.returncode == 0 and row.pop("ns_per_sample") >= 0.0
    assert row == {"file": "combbench-lead", "family": "control", "name": "lead"}


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ("        x.error = sum([s.error for _ in range(3)])", "an expression ListComp"),
        ("        with s:\n            pass", "a statement With"),
        ("        x.error = np.float128(s.error)", "np is not known at this place"),
    ],
)
def test_a_step_of_a_package_outside_the_notation_is_told_with_its_place_and_the_way_out(
    installed: Installed, wrong: str, says: str
) -> None:
    file, right = installed.source / "lead.py", "        x.error = s.error"
    text = file.read_text("utf-8")
    assert text.count(right) == 1
    file.write_text(text.replace(right, wrong), "utf-8")
    ended = checked(installed, "combbench-lead")
    line = 1 + text.split("\n").index(right)
    column = 9 if "with" in wrong else wrong.index("np" if "np" in wrong else "[") + 1
    assert ended.returncode == 2 and ended.stderr == ""
    assert ended.stdout == f"combbench-lead: {file}:{line}:{column}: {says} ({NOTATION})\n"


@pytest.mark.long
def test_pytest_runs_the_test_of_the_template(installed: Installed) -> None:
    folder = str(installed.source)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", folder, folder]
    done = subprocess.run(command, cwd=folder, env=installed.environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    assert "2 passed" in done.stdout


def test_a_package_that_cannot_be_loaded_is_refused_by_its_name() -> None:
    entry = EntryPoint("none", "no_such_module:None", "combbench.control")
    with pytest.raises(InputError) as raised:
        registry._loaded(entry)
    assert raised.value.field == "combbench.control.none"
    assert "names no_such_module:None, which cannot be loaded" in str(raised.value)


def break_one(folder: Path, family: str) -> None:
    """Put a package into a folder that names a module that is not there."""
    info = folder / "broken-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: broken\nVersion: 1.0\n", "utf-8")
    (info / "entry_points.txt").write_text(f"[combbench.{family}]\nnone = no_such_module:None\n", "utf-8")


@pytest.fixture(params=["control", "readout"])
def broken(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """The family of such a package, which this Python finds until the end of the test."""
    break_one(tmp_path, request.param)
    known: list[Any] = [registry._entry_points, registry._all, registry.blocks, registry.apart, packages]
    with pytest.MonkeyPatch.context() as patched:
        patched.syspath_prepend(tmp_path)
        for one in known:
            one.cache_clear()
        yield request.param
    for one in known:
        one.cache_clear()


def test_a_run_is_refused_in_one_line_where_a_package_cannot_be_loaded(broken: str) -> None:
    done = CliRunner().invoke(app, ["run", "first-look", "--set", "controller.kind=none"])
    assert (done.exit_code, done.stdout) == (2, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"combbench: combbench.{broken}.none: broken names no_such_module:None")


@pytest.mark.long
def test_the_command_line_names_a_package_that_cannot_be_loaded(installed: Installed, tmp_path: Path) -> None:
    break_one(tmp_path, "control")
    path = f"{tmp_path}:{installed.environment['PYTHONPATH']}"
    command = [sys.executable, "-m", "server.cli.main", "catalog", "control"]
    environment = {**installed.environment, "PYTHONPATH": path}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and done.stdout == ""
    (line,) = done.stderr.strip().split("\n")
    assert line.startswith("combbench: combbench.control.none: broken names no_such_module:None")
