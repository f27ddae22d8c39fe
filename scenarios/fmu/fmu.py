"""Writes a bench as an FMU of FMI 3.0: native code for the platform of this machine, without Python."""

from __future__ import annotations

import hashlib
import os
import tempfile
import zipfile
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from core.compile.machine import Target, levels, native
from core.compile.numbers import Unsupported
from core.errors import InputError
from scenarios.fmu.description import MODEL, description
from scenarios.fmu.layout import layout
from scenarios.fmu.linker import compiler, link
from scenarios.fmu.object_code import object_of
from scenarios.fmu.source import source
from scenarios.schema import Scenario

STAMP = (1980, 1, 1, 0, 0, 0)
"""Time of all files, so that an FMU is the same each time."""


class WrittenFmu(NamedTuple):
    """Step of an FMU in s, its platform, and the parts of the bench that it lacks, each with the reason."""

    step_s: float
    platform: str
    left_out: list[str]


def export(scenario: Scenario, path: Path, version: str) -> WrittenFmu:
    """Write a bench without its controllers as a co-simulation FMU; the file is replaced once it is whole.

    Parameters
    ----------
    scenario : Scenario
        Its sample interval is the step of the FMU; its seed decides the noise.
    path : Path
        The file.
    version : str
        Of the program.

    Raises
    ------
    InputError
        For a scenario that cannot be an FMU, and where no compiler links.
    OSError
        When the file cannot be written.
    """
    platform, target = _platform()
    compiler()
    one = layout(scenario)
    blocks = [*dict.fromkeys(one.board.wiring.instances[row].block for row in one.rows)]
    try:
        code = object_of(blocks, target)
    except Unsupported as error:
        raise InputError(f"{scenario.id} cannot be an FMU: {error}", "scenario") from None
    runtime = files("scenarios.fmu").joinpath("bench.c").read_text("utf-8")
    token = hashlib.sha256(code + source(one, blocks, "").encode() + runtime.encode()).hexdigest()
    described = description(scenario, one, token, version)
    library = f"{MODEL}.so"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "steps.o").write_bytes(code)
        (folder / "bench.c").write_text(runtime, "utf-8")
        (folder / "numbers.h").write_text(source(one, blocks, token), "utf-8")
        link(folder, ["bench.c", "steps.o"], library)
        made = (folder / library).read_bytes()
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, whole = tempfile.mkstemp(dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file, zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
            for inside, content in (("modelDescription.xml", described), (f"binaries/{platform}/{library}", made)):
                entry = zipfile.ZipInfo(inside, STAMP)
                entry.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(entry, content)
        os.replace(whole, path)
    except BaseException:
        Path(whole).unlink(missing_ok=True)
        raise
    return WrittenFmu(one.board.dt_ms / 1e3, platform, one.left_out)


def _platform() -> tuple[str, Target]:
    """Return the name of this platform in FMI, and the least processor of it.

    Raises
    ------
    InputError
        Where no code is made for others.
    """
    known = levels()
    if not known:
        raise InputError(f"FMUs are made on Linux on x86-64 and ARM, not on {native().triple}", "fmu")
    return f"{known[-1].triple.partition('-')[0]}-linux", known[-1]
