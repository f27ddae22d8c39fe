"""Tests wait for states and messages; only the tests in tests/wall_clock.txt wait for the clock of the machine."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

SLEEPERS = ("time", "asyncio", "anyio", "trio")
FIXTURE = "on_the_wall"


def is_wait(node: ast.AST) -> bool:
    """Whether a piece of code sleeps, or asks for a server by the clock of the machine."""
    if isinstance(node, ast.arg):
        return node.arg == FIXTURE
    if isinstance(node, ast.keyword):
        return node.arg == "clock" and isinstance(node.value, ast.Constant) and node.value.value == "machine"
    if not isinstance(node, ast.Attribute) or node.attr != "sleep" or not isinstance(node.value, ast.Name):
        return False
    return node.value.id in SLEEPERS


def is_turn(node: ast.AST) -> bool:
    """Whether a call lets the event loop turn, for no time."""
    return isinstance(node, ast.Call) and [ast.unparse(one) for one in node.args] == ["0"] and is_wait(node.func)


def waits(path: Path) -> Iterator[str]:
    """Name the functions and classes of a file that wait by the clock; code outside of them has no name."""
    for part in ast.parse(path.read_text()).body:
        turns = {id(node.func) for node in ast.walk(part) if isinstance(node, ast.Call) and is_turn(node)}
        if any(is_wait(node) and id(node) not in turns for node in ast.walk(part)):
            yield getattr(part, "name", "")


def listed(root: Path) -> dict[str, str]:
    """Return the list: file and function, and the reason."""
    lines = (root / "tests" / "wall_clock.txt").read_text().splitlines()
    rows = [line.split(maxsplit=1) for line in lines if line and not line.startswith("#")]
    assert all(len(row) == 2 for row in rows), "each line has a reason"
    return dict(rows)


def test_only_the_tests_of_the_list_wait_for_the_clock_of_the_machine(root: Path, files: list[Path]) -> None:
    tests = [path for path in files if path.suffix == ".py" and path.is_relative_to(root / "tests")]
    found = {f"{path.relative_to(root)}::{name}" for path in tests for name in waits(path)}
    known = listed(root)
    assert found - known.keys() == set(), "await a state or a message, or add a line with the reason"
    assert known.keys() - found == set(), "these wait no more: delete their lines"


def test_a_wait_is_found_in_every_spelling(tmp_path: Path) -> None:
    path = tmp_path / "test_some.py"
    path.write_text(
        "import asyncio, time\n"
        "def one():\n    time.sleep(0.1)\n"
        "async def two():\n    await asyncio.sleep(1)\n"
        "def three(on_the_wall): ...\n"
        "def four(serve):\n    serve(clock='machine')\n"
        "def five(engine):\n    engine.submit(time.sleep, 0.1)\n"
        "async def turns():\n    await asyncio.sleep(0)\n"
        "def plain(live):\n    live.advance(seconds=1.0)\n"
    )
    assert list(waits(path)) == ["one", "two", "three", "four", "five"]
