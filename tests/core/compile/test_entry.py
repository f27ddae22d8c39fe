"""What Python calls of a kernel: arrays, numbers and records go in, numbers come out, as plain Python does it."""

from __future__ import annotations

import ctypes
import os
import pickle
import subprocess
import sys
import threading
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)
from core import kernel_cache
from core.compile.instructions import address_of, bits_of, call
from core.compile.numbers import Unsupported
from core.kernel import kernel
from core.plain import plain
from core.record import Record, Vector, vector

DTYPES = np.float64, np.float32, np.int64, np.uint64, np.bool_
LENGTH = 4


class Point(Record):
    x: float
    kept: Vector = vector(3)


@kernel
def sums(a: Any, b: Any) -> Any:
    rows, columns = a.shape
    total, last = 0.0, 0.0
    for i in range(rows):
        for k in range(columns):
            total += a[i, k] * b[k]
        last = a[i, -1]
    return total, rows, last, len(b)


@kernel
def turned(a: Any, out: Any) -> None:
    for i in range(a.shape[0]):
        out[:, i] = a[i]


@kernel
def copied(a: Any, out: Any) -> None:
    for k in range(len(a)):
        out[k] = a[k]
        out[k] = a[len(a) - 1 - k] if k > 1 else a[k]


@kernel
def in_parts(a: Any, out: Any) -> float:
    middle = a[1:-1, 1:]
    room = np.zeros((2, LENGTH))
    single = np.empty(LENGTH, dtype=np.float32)
    room[0, : middle.shape[1]] = middle[0]
    for k in range(LENGTH):
        single[k] = 0.1 * room[0, k]
    room[1, :2] = room[0, 1:3]
    out[:2, :] = room[:, :3]
    out[2, :] = 5.0
    out[2, 1] += single[1]
    return float(single[2]) + np.float32(0.1)


@kernel
def words(a: Any, out: Any) -> int:
    bits = a.view(np.uint64)
    for k in range(len(a)):
        out[k] = (bits[k] ^ np.uint64(0xFF51AFD7ED558CCD)) * np.uint64(0xC2B2AE3D27D4EB4F) >> np.uint64(29)
    return a.view(np.int64)[0] - bits_of(a[0])


@kernel
def of_a_point(point: Point, by: float, other: Point) -> float:
    for k in range(3):
        point.kept[k] += by * other.kept[k]
    point.x = by
    return point.x


@kernel
def said(n: int, x: float, yes: bool) -> Any:
    if yes:
        return n, x, n > 3
    return n + 1, x * x, True


@kernel
def nothing(n: int) -> None:
    if n > 3:
        return


@pytest.fixture
def a() -> Any:
    return np.random.default_rng(3).normal(size=(5, 4))


@pytest.mark.parametrize(
    "part", [lambda a: a, lambda a: a.T, lambda a: a[::2, 1:], lambda a: a[:, ::-1], lambda a: np.asfortranarray(a)]
)
def test_rows_columns_and_parts_are_read_where_they_are(a, part):
    given = part(a)
    b = np.arange(1.0, 1.0 + given.shape[1])
    plain_total = plain(sums)(given, b)
    assert sums(given, b) == plain_total
    out, other = np.zeros((2, *given.shape[::-1]))
    turned(given, out)
    np.testing.assert_array_equal(out, given.T)
    wide = np.zeros((given.shape[1], 2 * given.shape[0]))
    turned(given, wide[:, ::2])
    np.testing.assert_array_equal(wide[:, ::2], given.T)
    assert not wide[:, 1::2].any() and not other.any()


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("other", DTYPES)
def test_elements_of_every_kind_become_those_of_another_as_numpy_makes_them(dtype, other):
    least = 2 if np.uint64 in (dtype, other) else -2  # Python makes no word of a number below 0
    given = np.array([0, 1, 3, least, 2**40 + 1]).astype(dtype)
    out, theirs = np.zeros(5, other), np.zeros(5, other)
    copied(given, out)
    plain(copied)(given, theirs)
    np.testing.assert_array_equal(out, theirs)


def test_slices_fills_and_scratch(a):
    out, other = np.zeros((2, 3, 3))
    found = in_parts(a, out)
    assert found == plain(in_parts)(a, other)
    np.testing.assert_array_equal(out, other)


def test_words(a):
    out, other = np.zeros((2, 4), np.uint64)
    with np.errstate(over="ignore"):
        assert words(a[0], out) == plain(words)(a[0], other) == 0
    np.testing.assert_array_equal(out, other)


def test_records_are_written_where_they_are():
    point, other = Point(np.arange(4.0)), Point(np.ones(4))
    expected = point.array + np.array([0.0, 2.0, 2.0, 2.0])
    assert of_a_point(point, 2.0, other) == 2.0
    np.testing.assert_array_equal(point.array[1:], expected[1:])
    assert point.x == 2.0


def test_results_have_the_kinds_of_python():
    for arguments in ((4, 0.5, True), (2, 1.5, True), (2, 1.5, False)):
        found = said(*arguments)
        assert found == said.py_func(*arguments)
        assert [type(one) for one in found] == [int, float, bool]
    assert nothing(1) is None and nothing(5) is None
    assert said(n=4, x=0.5, yes=True) == (4, 0.5, True)


class Count(int):
    pass


def test_numbers_and_arrays_of_any_make_are_taken(tmp_path):
    a = np.arange(12.0).reshape(3, 4)
    b = np.ones(4)
    expected = plain(sums)(a, b)
    unpickled = pickle.loads(pickle.dumps(a))
    mapped = np.memmap(tmp_path / "a", dtype=np.float64, mode="w+", shape=(3, 4))
    mapped[:] = a
    for one in (a, unpickled, mapped, a.astype("<f8"), np.asfortranarray(a), a):
        assert sums(one, b) == expected
    for number in (2, np.int64(2), np.int32(2), Count(2), True):
        assert said(number, np.float32(0.5), np.bool_(False)) == (int(number) + 1, 0.25, True)
    assert said(2, 3, False) == (3, 9, True)


def test_what_no_kernel_takes_is_refused():
    with pytest.raises(TypeError, match="no kernel takes str"):
        nothing("one")
    with pytest.raises(TypeError, match="no kernel takes ndarray"):
        sums(np.zeros((2, 2), np.int16), np.zeros(2))
    with pytest.raises(OverflowError):
        nothing(2**70)
    with pytest.raises(TypeError):
        nothing()


@kernel
def makes_an_array(n: int) -> float:
    room = np.zeros(n)
    return room[0]  # type: ignore[no-any-return]


@kernel
def gives_an_array(a: Any) -> Any:
    return a


def test_what_is_outside_the_notation_says_where_and_what_helps():
    with pytest.raises(Unsupported, match="length is not known") as raised:
        makes_an_array(3)
    line = makes_an_array.py_func.__code__.co_firstlineno + 2
    assert raised.value.field == f"{__file__}:{line}:12" and raised.value.hint == "let the caller give it"
    with pytest.raises(Unsupported, match="a result that is no number"):
        gives_an_array(np.zeros(2))


@kernel
def asks_and_waits(byte: Any, write: int, asked: int, read: int, answered: int) -> None:
    call(write, asked, address_of(byte), 1, 0)
    call(read, answered, address_of(byte), 1, 0)


@pytest.mark.skipif(os.name != "posix", reason="this system has other pipes")
def test_other_threads_run_while_a_kernel_is_at_work_on_arrays():
    """The kernel waits in the system for what this thread writes once it is asked."""
    write, read = (ctypes.cast(getattr(ctypes.CDLL(None), name), ctypes.c_void_p).value for name in ("write", "read"))
    (asked, asks), (answered, answers) = os.pipe(), os.pipe()
    byte = np.zeros(1, np.int64)
    thread = threading.Thread(target=asks_and_waits, args=(byte, write, asks, read, answered), daemon=True)
    thread.start()
    assert os.read(asked, 1) == b"\0"
    os.write(answers, b"x")
    thread.join()
    assert byte[0] == ord("x")
    for one in (asked, asks, answered, answers):
        os.close(one)


def test_the_address_of_an_array_is_that_of_numpy(a):
    @kernel
    def where(x: Any) -> int:
        return address_of(x[1:, 2:])

    assert where(a) == a[1:, 2:].ctypes.data == plain(where)(a)


def test_a_text_that_has_changed_since_it_was_loaded_is_not_compiled(tmp_path, monkeypatch):
    """Its code would be kept under the name of the code before."""
    monkeypatch.setattr(kernel_cache, "_shelves", [])  # the code before may be there
    file = tmp_path / "made_up.py"
    text = "from core.kernel import kernel\n\n\n@kernel\ndef doubled(x):\n    return 2.0 * x\n"
    file.write_text(text)
    module = ModuleType("made_up")
    exec(compile(text, str(file), "exec"), vars(module))
    file.write_text(text.replace("2.0 * x", "20.0 * x"))
    with pytest.raises(Unsupported, match="the text of doubled has changed since it was loaded"):
        module.doubled(1.0)
    file.write_text("# longer\n" + text)
    with pytest.raises(Unsupported, match="has changed"):
        module.doubled(1.0)
    file.write_text(text + "# another line\n")
    assert module.doubled(1.0) == 2.0


def test_a_kernel_is_whole_after_the_names_of_its_module_are_gone():
    """An interpreter that ends drops the names of modules first, and looks at all functions afterwards."""
    code = """
import ctypes, gc
import core.compile.entry as entry
from core.kernel import flush_tiny
assert flush_tiny(1.0) == 1.0
(made,) = flush_tiny._made.values()
vars(entry).clear()
gc.collect()
others = [ctypes.create_string_buffer(b"\\xff" * size) for size in (32, 64, 128) for _ in range(5000)]
gc.collect()
print(made.__name__, made(2.0))
"""
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout) == (0, "flush_tiny 2.0\n"), ended.stderr
