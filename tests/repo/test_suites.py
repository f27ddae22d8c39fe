"""Every test is in a suite: the short one, or the long one; a test that may take longer exists, and has its reason."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

import pytest

from tests import budget
from tests.budget import ALLOWED

LEAVES_OUT = re.compile(
    r"collect_ignore|pytest_ignore_collect|norecursedirs|__test__|mark\.skip\b|--(?:ignore|deselect)|xfail\("
)


def collected(path: Path) -> list[str]:
    """Return the names of the tests of a file; tests of a class follow its name."""
    body = ast.parse(path.read_text()).body
    classes = [node for node in body if isinstance(node, ast.ClassDef) and node.name.startswith("Test")]
    return [f"{node.name}::{name}" for node in classes for name in _functions(node.body)] + _functions(body)


def _functions(body: list[ast.stmt]) -> list[str]:
    functions = (node for node in body if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef))
    return [node.name for node in functions if node.name.startswith("test")]


@pytest.fixture(scope="module")
def modules(root: Path, files: list[Path]) -> dict[str, list[str]]:
    """The tests of each Python file below `tests`, by its path."""
    paths = [path for path in files if path.suffix == ".py" and path.is_relative_to(root / "tests")]
    return {path.relative_to(root).as_posix(): collected(path) for path in paths}


def test_every_file_with_tests_has_a_name_that_is_collected(modules: dict[str, list[str]]) -> None:
    named = {name for name in modules if re.fullmatch(r"test_\w+\.py", Path(name).name)}
    assert len(named) > 150 and {name for name, tests in modules.items() if tests} == named


def test_no_test_is_replaced_by_one_of_the_same_name(modules: dict[str, list[str]]) -> None:
    assert [name for name, tests in modules.items() if len(tests) != len(set(tests))] == []


def test_nothing_is_left_out_of_both_suites(root: Path, modules: dict[str, list[str]]) -> None:
    options = tomllib.loads((root / "pyproject.toml").read_text())["tool"]["pytest"]["ini_options"]
    assert options["testpaths"] == ["tests"] and not LEAVES_OUT.search(str(options))
    assert [name for name in modules if LEAVES_OUT.search((root / name).read_text()) and name != own(root)] == []
    assert [option for option in options["addopts"] if option.startswith(("-k", "-m"))] == []


def own(root: Path) -> str:
    return Path(__file__).relative_to(root).as_posix()


def test_the_long_suite_is_run_by_its_option_alone(root: Path) -> None:
    runner = (root / "scripts" / "run_tests.py").read_text()
    assert '*(["--long"] if long else [])' in runner and '"tests/' not in runner


def test_a_test_that_may_take_longer_exists_and_its_reason_is_a_sentence(modules: dict[str, list[str]]) -> None:
    names = [f"{module}::{test}" for module, tests in modules.items() for test in tests]
    assert [start for start in ALLOWED if not any(f"{name}[".startswith(start) for name in names)] == []
    assert [
        text for text in ALLOWED.values() if not re.fullmatch(r"[A-Z][^\n]*\w\.", text) or len(text.split()) < 4
    ] == []


def test_the_rules_find_a_test_that_is_not_collected(tmp_path: Path) -> None:
    file = tmp_path / "checks.py"
    file.write_text("def test_a(): ...\nasync def test_b(): ...\nclass TestC:\n    def test_d(self): ...\n")
    assert collected(file) == ["TestC::test_d", "test_a", "test_b"]
    assert all(LEAVES_OUT.search(text) for text in ("collect_ignore = []", "--ignore=tests/core", "__test__ = False"))


def test_a_test_is_listed_and_fails_by_a_unit_of_now(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(budget, "first_unit_s", lambda: 1.0)
    for now_s, units in ((2.0, [1.5, 2.5, 4.0, 7.0]), (0.5, [1.5, 10.0, 16.0, 28.0])):
        monkeypatch.setattr(budget, "unit_s", lambda now_s=now_s: now_s)
        assert [budget.units_of(seconds) for seconds in (1.5, 5.0, 8.0, 14.0)] == units
