"""The C compiler of the machine, or the one in the package ``ziglang``, which links a library."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

from core.errors import InputError

COMPILERS = ("cc", "gcc", "clang")
FLAGS = "-O2 -ffp-contract=off -fvisibility=hidden -shared -fPIC -w".split()


def compiler() -> list[str]:
    """Return the command of a C compiler.

    Raises
    ------
    InputError
        When there is none.
    """
    found = next((path for name in COMPILERS if (path := shutil.which(name))), None)
    if found:
        return [found]
    if importlib.util.find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "cc"]
    raise InputError(
        "an FMU needs a C compiler, and there is none",
        "fmu",
        "install cc, or the package ziglang: pip install '.[fmi]' in a checkout",
    )


def link(folder: Path, sources: list[str], library: str) -> None:
    """Link sources and object files of a folder into a library there.

    Raises
    ------
    InputError
        When there is no compiler, or it refuses.
    """
    command = [*compiler(), *FLAGS, "-o", library, *sources, "-lm"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        first = (done.stderr.strip().splitlines() or ["without a reason"])[0]
        raise InputError(f"{command[0]} could not link the FMU: {first[:300]}", "fmu")
