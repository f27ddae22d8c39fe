"""Numbers that people read are written in one place, ``core/format.py``."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

READ = (
    "scenarios/report",
    "core/board/words.py",
    "core/board/observer.py",
    "server/cli/main.py",
    "server/cli/run.py",
    "server/bench",
)
"""What writes for people."""


def _general(source: str) -> list[int]:
    """Return the lines on which a number is written by a general, scientific or percent format."""
    written = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FormattedValue)]
    return [
        node.lineno
        for node in written
        if node.format_spec is not None and ast.unparse(node.format_spec).rstrip("'\"")[-1:] in set("gGeE%n")
    ]


@pytest.mark.parametrize("place", READ)
def test_numbers_for_people_have_one_formatter(root: Path, place: str) -> None:
    """Reports, logs and tables leave the digits to the formatter."""
    start = root / place
    files = sorted(start.rglob("*.py")) if start.is_dir() else [start]
    astray = [f"{path.relative_to(root)}:{line}" for path in files for line in _general(path.read_text("utf-8"))]
    assert files
    assert not astray


def test_a_number_written_by_hand_is_found() -> None:
    """A format of digits is found, one of width or of coordinates is not."""
    assert _general("say(f'{x:.3g} {y:+g} {z:.1%}')") == [1, 1, 1]
    assert _general("say(f'{x:>10} {y:.1f} {z!r}')") == []
