"""The tutorials are right: every block is run unchanged, and its output equals the output printed beneath it."""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.server.conftest import TOKEN

ROOT = Path(__file__).resolve().parents[2]


def blocks(text: str) -> list[tuple[str, str | None]]:
    """Code, and its expected output where that is given; ``...`` matches any text."""
    found = re.findall(r"```python\n(.*?)```(?:\n\n```text\n(.*?)```)?", text, re.S)
    return [(code, said or None) for code, said in found]


def follow(name: str, least_printed: int) -> None:
    """Run every block of a tutorial, and compare its output with the output printed beneath it."""
    document = (ROOT / "docs" / name).read_text()
    code = blocks(document)
    assert len(code) == document.count("```python") and sum(said is not None for _, said in code) >= least_printed
    names: dict[str, Any] = {}
    for number, (block, said) in enumerate(code):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(block, f"docs/{name}, block {number}", "exec"), names)
        pattern = "".join(".+" if part == "..." else re.escape(part) for part in re.split(r"(\.\.\.)", said or ""))
        assert said is None or re.fullmatch(pattern, printed.getvalue()), f"{block}\nprinted\n{printed.getvalue()}"


def test_the_rest_tutorial(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COMBBENCH_ADDRESS", live.address)
    monkeypatch.setenv("COMBBENCH_TOKEN", TOKEN)
    follow("rest.md", 10)


def test_the_python_reference(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    follow("python.md", 6)


@pytest.mark.long
@pytest.mark.timeout(300)
def test_the_monte_carlo_example(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "monte_carlo_roc.py").read_text()
    assert "RUNS = 100\n" in text
    path = tmp_path / "example.py"
    path.write_text(text.replace("RUNS = 100\n", "RUNS = 6\n"))
    folder = Path(sys.executable).parent
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PATH": f"{folder}{os.pathsep}{os.environ['PATH']}"}
    done = subprocess.run(
        [sys.executable, path], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=280
    )
    assert done.returncode == 0, done.stderr
    points = json.loads((tmp_path / "monte-carlo-roc" / "points.json").read_text())
    areas = [point["diagnosis"]["kalman"]["roc"]["area"] for point in points]
    assert [point["runs"] for point in points] == [6] * 4
    # more noise, a worse detector; never worse than chance
    assert 0.98 < areas[0] <= 1.0 and 0.5 < areas[-1] < areas[0] and areas == sorted(areas, reverse=True)
    assert all(f"{area:.4f}" in done.stdout for area in areas) and done.stdout.count("act above") == 4
    assert "<svg" in (tmp_path / "monte-carlo-roc" / "roc.svg").read_text()
