"""The template of ``docs/template``, installed for a test as ``pip install -e`` leaves it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

from tests.core.own.texts import ROOT

TEMPLATE = ROOT / "docs" / "template"
ANSWERS = """
import importlib, json, sys, traceback
from contextlib import redirect_stdout
from core import registry
from core.board.packages import packages

said = sys.stdout
for line in sys.stdin:
    code, words = json.loads(line)
    importlib.invalidate_caches()
    registry._entry_points.cache_clear()
    packages.cache_clear()
    found = {"words": words}
    try:
        with redirect_stdout(sys.stderr):
            exec(code, found)
        answer = found["answer"], ""
    except Exception:
        answer = None, traceback.format_exc()
    print(json.dumps(answer), file=said, flush=True)
"""


class Installed:
    """A folder in which Python finds the template, from a copy of its source, and a Python that answers there."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.source = folder, folder / "source"
        self._project = tomllib.loads((TEMPLATE / "pyproject.toml").read_text("utf-8"))["project"]
        self.renew()
        self._python = subprocess.Popen(
            [sys.executable, "-c", ANSWERS],
            cwd=folder,
            env=self.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    @property
    def environment(self) -> dict[str, str]:
        """The environment in which Python finds it."""
        return {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (self.folder, self.source, ROOT)))}

    def renew(self) -> None:
        """Install the template as it comes."""
        shutil.rmtree(self.source, ignore_errors=True)
        shutil.copytree(TEMPLATE, self.source)
        self.rename(self._project["version"])

    def rename(self, version: str) -> None:
        """Install it as another version."""
        for old in self.folder.glob("*.dist-info"):
            shutil.rmtree(old)
        name = self._project["name"]
        self.info = self.folder / f"{name.replace('-', '_')}-{version}.dist-info"
        self.info.mkdir()
        (self.info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n", "utf-8")
        for group, units in self._project["entry-points"].items():
            for unit, where in units.items():
                self.enter(where, group, unit)

    def enter(self, where: str, group: str = "combbench.control", unit: str = "lead") -> None:
        """Name the class of its unit."""
        (self.info / "entry_points.txt").write_text(f"[{group}]\n{unit} = {where}\n", "utf-8")

    def answer(self, code: str, *words: Any) -> Any:
        """Return ``answer`` of code that is given ``words``; it looks for packages anew."""
        assert self._python.stdin is not None and self._python.stdout is not None
        self._python.stdin.write(json.dumps([code, words]) + "\n")
        self._python.stdin.flush()
        answer, error = json.loads(self._python.stdout.readline())
        assert not error, error
        return answer

    def end(self) -> None:
        """Let the Python that answers come to its end."""
        self._python.communicate()
