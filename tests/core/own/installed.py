"""The template of ``docs/template``, installed for a test as ``pip install -e`` leaves it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

from tests.core.own.texts import ROOT

TEMPLATE = ROOT / "docs" / "template"


class Installed:
    """A folder in which Python finds the template, from a copy of its source."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.source = folder, folder / "source"
        shutil.copytree(TEMPLATE, self.source)
        self._project = tomllib.loads((TEMPLATE / "pyproject.toml").read_text("utf-8"))["project"]
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

    def __call__(self, *words: str) -> subprocess.CompletedProcess[str]:
        """Call Python where it is installed."""
        path = os.pathsep.join(map(str, (self.folder, self.source, ROOT)))
        command = [sys.executable, *words]
        return subprocess.run(
            command,
            cwd=self.folder,
            env={**os.environ, "PYTHONPATH": path},
            capture_output=True,
            text=True,
            check=False,
        )
