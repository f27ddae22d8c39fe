"""The C compiler of the machine, if it has one: C in, functions out."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

FLAGS = "-O3 -march=native -ffp-contract=off -fno-math-errno -fno-trapping-math -shared -fPIC -w".split()
"""All that keeps the bits: no product and sum become one, and no sum changes its order."""


def compiler() -> str | None:
    """Return the path of the compiler, if the machine has one."""
    return shutil.which("gcc")


def version(path: str) -> str:
    """Return the name and the version of a compiler."""
    told = subprocess.run([path, "-dumpfullversion"], capture_output=True, text=True, check=True)
    return f"gcc {told.stdout.strip()}"


def libraries(path: str, texts: Mapping[str, str], folder: Path) -> dict[str, ctypes.CDLL]:
    """Compile texts in a folder, all at once, and return their functions, which return whole numbers.

    Raises
    ------
    RuntimeError
        When the compiler refuses a text.
    """
    running = {}
    for name, text in texts.items():
        (folder / f"{name}.c").write_text(text)
        command = [path, *FLAGS, "-o", f"{name}.so", f"{name}.c", "-lm"]
        running[name] = subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)
    told = {name: process.communicate()[1] for name, process in running.items()}
    for name, process in running.items():
        if process.returncode:
            raise RuntimeError(f"gcc refuses the C of {name}: {told[name].strip()[:500]}")
    return {name: ctypes.CDLL(str(folder / f"{name}.so")) for name in texts}


def library(path: str, text: str, folder: Path) -> ctypes.CDLL:
    """Compile a text and return its functions."""
    return libraries(path, {"board": text}, folder)["board"]
