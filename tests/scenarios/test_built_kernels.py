"""The machine code that an image or a wheel brings along: a first start compiles nothing, and damage is no kernel."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

import pytest

from core import kernel_cache, registry
from core.compile import code, entry
from core.compile.machine import LEVELS, native
from core.kernel import flush_tiny
from scenarios import built_kernels
from scenarios import kernel_cache as folders
from scenarios.kernel_cache import Built
from tests.library_pass import ROOT

PIECES = [code.step(registry.block("control", "pid")), entry.piece(flush_tiny.py_func, ("float64",))]


@pytest.fixture
def archive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return an archive of two pieces."""
    monkeypatch.setattr(built_kernels, "called", lambda: [PIECES[1]])
    monkeypatch.setattr(built_kernels, "steps", lambda: [("control", "pid", 1)])
    assert built_kernels.write(tmp_path / "built.zip") == len(PIECES) * len(LEVELS)
    return tmp_path / "built.zip"


def got(path: Path, monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Return which of the pieces an archive has, for each level in turn."""
    monkeypatch.setattr(kernel_cache, "_shelves", [Built(path)])
    return [kernel_cache.get(piece.name_for(level)) is not None for level in LEVELS for piece in PIECES]


def test_an_archive_has_each_piece_for_each_level_and_nothing_is_put_into_it(archive, monkeypatch):
    assert got(archive, monkeypatch) == [True] * 6
    before = archive.read_bytes()
    kernel_cache.put("more", b"code")
    assert kernel_cache.get("more") is None and archive.read_bytes() == before
    assert [path.name for path in archive.parent.iterdir()] == ["built.zip"]


def test_a_part_that_is_damaged_is_no_kernel_and_the_others_are(archive, monkeypatch):
    whole = archive.read_bytes()
    with ZipFile(archive) as files:
        first = files.infolist()[0]
    place = first.header_offset + 30 + len(first.filename) + first.compress_size // 2
    archive.write_bytes(whole[:place] + bytes([whole[place] ^ 255]) + whole[place + 1 :])
    assert sorted(got(archive, monkeypatch)) == [False] + [True] * 5
    for rest in (b"", whole[: len(whole) // 2]):
        archive.write_bytes(rest)
        assert got(archive, monkeypatch) == [False] * 6
    archive.unlink()
    assert got(archive, monkeypatch) == [False] * 6


@pytest.mark.parametrize("built", [True, False])
def test_the_folder_of_a_user_comes_before_what_a_version_brings(tmp_path, monkeypatch, built):
    shelves: list[object] = []
    monkeypatch.setattr(folders, "folder", lambda: tmp_path)
    monkeypatch.setattr(folders, "keep_on", lambda *given: shelves.extend(given))
    folders.prepare(built=built)
    assert [type(one).__name__ for one in shelves] == ["Folder", "Built"][: 1 + built]


NAMES = """
from core import registry
from core.compile import code, machine
piece = code.step(registry.block("control", "pid"))
for target in (machine.native(), *machine.LEVELS):
    print(piece.name_for(target))
"""


def test_another_bytecode_of_the_same_text_finds_the_code_that_an_archive_brings():
    """Each version of Python has its own bytecode; one version has two, with docstrings and without."""
    command = [sys.executable, "-OO", "-c", NAMES]
    told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    own, *levels = (PIECES[0].name_for(target) for target in (native(), *LEVELS))
    assert told[1:] == levels and told[0] != own


START = """
import sys
from pathlib import Path
from core.compile import code, machine
from scenarios import kernel_cache
kernel_cache.BUILT = Path(sys.argv[1])
kernel_cache.Built.__init__.__defaults__ = (kernel_cache.BUILT,)
kernel_cache.prepare()
code.levels = lambda: [level for level in machine.LEVELS if level.processor == sys.argv[2]]
from core import kernel_cache as kernels
from scenarios.kernels import load
from scenarios.library import library
from scenarios.run import build
load()
for scenario in library():
    build(scenario).advance(1)
print(len(kernels.compiled_here), len(code.borrowed), *kernels.compiled_here)
"""


@pytest.mark.long
@pytest.mark.timeout(1800)
def test_a_first_start_compiles_nothing_at_any_level(tmp_path):
    """Every scenario of the library, its first tick included, from an empty folder."""
    path = tmp_path / "built.zip"
    count = built_kernels.write(path)
    assert count % len(LEVELS) == 0
    for level in ("x86-64-v2", "x86-64-v3"):
        told = subprocess.run(
            [sys.executable, "-c", START, str(path), level],
            cwd=ROOT,
            env={"PYTHONPATH": str(ROOT), "COMBBENCH_KERNEL_CACHE": str(tmp_path / level), "PATH": "/usr/bin:/bin"},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        compiled, borrowed, *names = told
        assert (compiled, names) == ("0", []) and int(borrowed) > 100
