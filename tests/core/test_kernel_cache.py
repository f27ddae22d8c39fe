"""A compiled kernel is identified by its code and by the code of every function it names; it is compiled once."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path
from types import FunctionType, ModuleType, SimpleNamespace

import pytest

from core import kernel_cache
from core.kernel_cache import key

ROOT = Path(__file__).resolve().parents[2]

SOURCE = """
from core.kernel import kernel, inlined
import math
import numpy as np

FACTOR = 2.0
NODES = np.array([1.0, 2.0])
UNUSED = 1

@kernel
def deepest(x):
    return x * FACTOR

@inlined
def inner(x):
    return deepest(x) + NODES[1]

@kernel
def outer(x):
    '''Say nothing.'''
    return inner(x) + 3.0
"""


def outer_of(source: str) -> FunctionType:
    module = ModuleType("core.made_up")
    exec(compile(source, "made_up.py", "exec"), vars(module))
    return module.outer.py_func


def test_the_key_is_the_same_every_time():
    assert key(outer_of(SOURCE)) == key(outer_of(SOURCE))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("x * FACTOR", "x / FACTOR"),
        ("FACTOR = 2.0", "FACTOR = 2.5"),
        ("[1.0, 2.0]", "[1.0, 2.5]"),
        ("+ 3.0", "+ 4.0"),
        ("NODES[1]", "NODES[0]"),
        ("inner(x) + 3.0", "deepest(x) + 3.0"),
    ],
)
def test_the_key_changes_with_the_code_it_rests_on(old, new):
    assert old in SOURCE
    assert key(outer_of(SOURCE.replace(old, new))) != key(outer_of(SOURCE))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("UNUSED = 1", "UNUSED = 2"),
        ("    return inner(x)", "    # a comment\n\n    return inner(x)"),
        ("FACTOR = 2.0", "\n\nFACTOR = 2.0"),
        ("Say nothing", "Say something else"),
    ],
)
def test_the_key_stays_where_nothing_compiled_changes(old, new):
    assert old in SOURCE
    assert key(outer_of(SOURCE.replace(old, new))) == key(outer_of(SOURCE))


def test_the_order_in_which_bytecode_names_things_is_part_of_the_bytecode_alone():
    turned = SOURCE.replace("deepest(x) + NODES[1]", "NODES[1] + deepest(x)")
    assert key(outer_of(turned)) != key(outer_of(SOURCE))

    def name(function: FunctionType) -> str:
        return function.__name__

    assert key(outer_of(turned), name) == key(outer_of(SOURCE), name)
    for old, new in (("FACTOR = 2.0", "FACTOR = 2.5"), ("[1.0, 2.0]", "[1.0, 2.5]")):
        assert key(outer_of(SOURCE.replace(old, new)), name) != key(outer_of(SOURCE), name)


def test_a_kernel_that_calls_itself_has_a_key():
    source = SOURCE.replace("return inner(x) + 3.0", "return outer(x - 1.0) if x > 0.0 else 3.0")
    assert key(outer_of(source)) == key(outer_of(source)) != key(outer_of(SOURCE))


PROGRAM = """
import scenarios
from core import kernel_cache
from core.kernel import kernel
from core.record import Record
import {module} as made
print(made.outer(1.0), len(kernel_cache.compiled_here))
"""


def outer_in_a_process(folder: Path, source: str) -> list[str]:
    (folder / "made_up_kernels.py").write_text(textwrap.dedent(source))
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(module="made_up_kernels")],
        cwd=ROOT,
        env={
            "PYTHONPATH": f"{ROOT}:{folder}",
            "PYTHONDONTWRITEBYTECODE": "1",  # two edits within a second are one to Python's own cache
            "COMBBENCH_KERNEL_CACHE": str(folder / "kept"),
            "PATH": "/usr/bin:/bin",
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout.split()


def test_a_second_process_compiles_nothing_an_edit_what_it_touches_and_damage_everything(tmp_path):
    assert outer_in_a_process(tmp_path, SOURCE) == ["7.0", "1"]
    assert outer_in_a_process(tmp_path, SOURCE) == ["7.0", "0"]
    assert outer_in_a_process(tmp_path, SOURCE.replace("+ 3.0", "+ 4.0")) == ["8.0", "1"]
    assert outer_in_a_process(tmp_path, SOURCE.replace("FACTOR = 2.0", "FACTOR = 3.0")) == ["8.0", "1"]
    for path in (tmp_path / "kept" / "kernels").iterdir():
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    assert outer_in_a_process(tmp_path, SOURCE) == ["7.0", "1"]


def test_a_file_of_another_name_or_with_other_bytes_is_no_kernel(monkeypatch):
    files: dict[str, bytes] = {}
    shelf = SimpleNamespace(get=files.get, put=files.__setitem__)
    monkeypatch.setattr(kernel_cache, "_shelves", [shelf])
    kernel_cache.put("one", b"code")
    kernel_cache.put("empty", b"")
    assert kernel_cache.get("one") == b"code" and kernel_cache.get("empty") == b"" and kernel_cache.get("two") is None
    files["two"] = files["one"]
    files["old"] = b"code"
    assert kernel_cache.get("two") is None and kernel_cache.get("old") is None
    for place in range(len(files["one"])):
        changed = bytearray(files["one"])
        changed[place] ^= 1
        files["changed"] = bytes(changed)
        assert kernel_cache.get("changed") is None
    files["one"] = files["one"][:-1]
    assert kernel_cache.get("one") is None
