"""The list of sentences for a second look: it finds known patterns, leaves plain sentences alone, and never fails."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture(scope="module")
def prose(root: Path) -> ModuleType:
    """The script."""
    spec = importlib.util.spec_from_file_location("prose", root / "scripts" / "prose.py")
    assert spec is not None and spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    return script


@pytest.mark.parametrize(
    ("sentence", "rule"),
    [
        ("What is asked of the bench comes back.", "a pronoun in place of a noun"),
        ("It keeps a bench that nobody watches.", "a pronoun in place of a noun"),
        ("The board hears of every event.", "a thing that acts like a person"),
        ("A file is read, its rows are checked, and the run is refused.", "a chain of passives"),
        (f"The bench {'and the board ' * 15}run.", "a long sentence"),
    ],
)
def test_a_known_pattern_is_found(prose: ModuleType, sentence: str, rule: str) -> None:
    assert [found for found, _ in prose.findings(f"A block computes a tick. {sentence}")] == [rule]


def test_a_plain_sentence_is_not_listed(prose: ModuleType) -> None:
    text = "A board runs its blocks in order. What is a block? The bench looks up the signal; it is checked once."
    assert [sentence for _, sentence in prose.findings(text)] == []


def test_prose_of_each_kind_of_file_is_read(prose: ModuleType, tmp_path: Path) -> None:
    texts = {
        "a.py": '"""First line.\n\nSecond."""\nx = "no prose"\n# A comment.\n',
        "a.md": "# Title\n\nA line.\n```\ncode\n```\n",
        "a.ts": '/** A note. */\nconst x = "no prose"; // Another.\n',
    }
    found = {}
    for name, text in texts.items():
        path = tmp_path / name
        path.write_text(text)
        found[name] = [(first, last, " ".join(said.split())) for first, last, said in prose.said_in(path)]
    assert found["a.py"] == [(1, 3, "First line. Second."), (5, 5, "A comment.")]
    assert found["a.ts"] == [(1, 1, "A note."), (2, 2, "Another.")]
    assert [said for _, _, said in found["a.md"]] == ["# Title", "A line."]


def test_the_list_is_information_and_no_failure(root: Path, tmp_path: Path) -> None:
    path = tmp_path / "bad.md"
    path.write_text("What is asked of the board hears nobody.\n")
    command = [sys.executable, root / "scripts" / "prose.py", path]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "bad.md:1: a pronoun in place of a noun" in done.stdout
