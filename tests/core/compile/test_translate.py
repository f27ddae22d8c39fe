"""The translation of a step gives each board the bits of plain Python."""

from __future__ import annotations

import ctypes
import math
from typing import Any

import numpy as np
import pytest

import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)
from core import kernel_cache
from core.compile import code
from core.compile.machine import WIDTH, Target, compiled, loaded
from core.compile.numbers import Unsupported
from core.elementary import atan2, cos, exp, expm1, floor, log, sin, sin_of_turns, tanh
from core.kernel import kernel
from core.noise import normal
from core.plain import plain
from core.ports import RESERVED, BlockPorts, output, reads
from core.record import Choice, Record, Records, Vector, several, tail, vector

SIZE = 5
TABLE = np.array([1.5, -2.0, 0.25, 8.0, 3.0])


class Pair(Record):
    first: float
    second: float


class Packed(Record):
    count: Choice
    level: float
    steps: float
    weights: Vector = vector(SIZE)
    pair: Pair
    rest: Vector = tail()


class State(Record):
    sum: float
    place: float
    kept: Pair
    other: Pair
    ring: Vector = vector(SIZE)
    pairs: Records[Pair] = several(SIZE)


class Ports(BlockPorts):
    a: float = reads("a")
    b: float = reads("b")
    vector: Vector = reads("v")
    y: float = output("1", "result")
    z: Vector = output("1", "results", labels=tuple("12345"))


@kernel
def clipped(value: float, level: float) -> float:
    if not math.isfinite(value):
        return 0.0
    if value > level:
        return level
    value = max(value, -level)
    return value


@kernel
def parts(value: float) -> tuple[float, int]:
    whole = floor(value)
    if whole < 0:
        return value, 0
    return value - whole, whole


def arithmetic(p, s, x):
    x.y = -(x.a + x.b) * p.level / (x.a - x.b) + abs(x.a) ** 2
    s.sum += x.y if x.y == x.y else 1.0
    x.z[0] = min(x.a, x.b, p.level)
    x.z[1] = max(x.a, x.b)
    x.z[2] = math.copysign(x.a, x.b) + math.sqrt(abs(x.b))
    x.z[3] = x.a % 3.0 + math.copysign(1.0, (2.0 * floor(x.b)) % -2.0) if abs(x.a) + abs(x.b) < 1e9 else 0.0
    x.z[4] = float(int(x.tick) % 7 // 2) + (1.0 if x.tick % 2.0 == 1.0 else 0.0)


def returns_early(p, s, x):
    x.y = clipped(x.a, p.level)
    if x.a > x.b:
        s.sum += 1.0
        if x.a > 2.0 * x.b:
            x.z[0] = 7.0
            return
        x.z[1] = x.y
    s.place = x.y
    x.z[2] = x.b


def returns_several(p, s, x):
    rest, whole = parts(x.a if abs(x.a) < 1e6 else 0.5)
    s.ring[whole % SIZE] += rest
    x.y, x.z[0] = rest, float(whole)
    a, b = x.a, x.b
    a, b = b, a
    x.z[1] = a - b


def chooses(p, s, x):
    if x.a < x.b < p.level or not x.a > 0.0:
        y = 1.0
    elif x.a == x.b:
        y = 2.0
    else:
        y = -x.a
        if p.count == 3.0 and x.b != 0.0:
            y += x.b
    x.y = y
    x.z[0] = 1.0 if x.a > 0.0 and x.b > 0.0 else (2.0 if x.b > 1.0 else 3.0)


@kernel
def counted(s: State) -> float:
    s.sum += 1.0
    return s.sum


def computes_what_is_needed(p, s, x):
    x.y = counted(s) if p.count == 4.0 else -1.0
    x.z[0] = 1.0 if p.count == 3.0 or counted(s) > 0.0 else 2.0
    x.z[1] = float(int(x.tick) % int(p.count - 3.0)) if p.count != 3.0 else 5.0
    x.z[2] = counted(s) if p.count == 3.0 and x.tick > 5.0 else 0.0
    x.z[3] = counted(s) if x.a > 0.0 else 0.0


def loops(p, s, x):
    total = 0.0
    best = 0
    for i in range(int(p.count)):
        total += p.weights[i] * x.vector[i]
        if p.weights[i] > p.weights[best]:
            best = i
    for i in range(SIZE - 1, -1, -1):
        if s.ring[i] > 10.0:
            continue
        s.ring[i] += total * TABLE[i]
        if s.ring[i] > p.level:
            break
    x.y = total + p.rest[0] - p.rest[1]
    x.z[0] = float(best)
    x.z[1] = p.weights[best]
    s.pairs[best].first += 1.0
    s.pairs[best].second = s.pairs[0].first


def loops_of_other_lengths(p, s, x):
    total = 0.0
    for i in range(int(p.steps)):
        total = 0.5 * total + i + x.b
        if total > 4.0:
            break
    n = 0
    value = abs(x.a) if math.isfinite(x.a) else 1.0
    while value > 1.0 and n < 40:
        value *= 0.5
        n += 1
        if n == 5:
            continue
        s.sum += value
    x.y = total
    x.z[0] = float(n)


def copies(p, s, x):
    if x.a > 0.0:
        s.kept = p.pair
        s.kept.first += x.b
    x.y = s.kept.first + s.kept.second
    s.other = s.kept


def functions(p, s, x):
    a = x.a if abs(x.a) < 50.0 else 0.5
    x.y = exp(a) + log(abs(a) + 1e-3) + tanh(a)
    x.z[0] = sin(a) + cos(a) * expm1(a)
    x.z[1] = atan2(a, x.b)
    x.z[2] = sin_of_turns(a)
    x.z[3] = normal(9007199254740.0, x.tick) + normal(abs(a) * 1e9, x.tick)


STEPS = (
    arithmetic,
    returns_early,
    returns_several,
    chooses,
    computes_what_is_needed,
    loops,
    loops_of_other_lengths,
    copies,
    functions,
)


def unit(step: Any) -> Any:
    return type(step.__name__, (), {"step": step, "Packed": Packed, "State": State, "Ports": Ports})


def call(step: Any, p: Any, s: Any, w: Any, io: Any, width: int, *, lanes: bool) -> None:
    text = code.instructions(unit(step), width, lanes=lanes)
    function = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(loaded(compiled(text, loops=width == 1)))
    for k in range(0, WIDTH, width):
        own = [np.ascontiguousarray(array[:, k : k + width]) for array in (p, s, w)]
        for tick in range(1, 30):
            own[2][0] = tick
            own[2][1] = 0.01 * tick
            function(*(array.ctypes.data for array in (*own, io)))
        for array, now in zip((s, w), own[1:], strict=True):
            array[:, k : k + width] = now


@pytest.fixture
def arrays() -> Any:
    rng = np.random.default_rng(5)
    p = rng.normal(size=(Packed.layout.numbers(2), WIDTH))
    record = Packed(np.arange(float(len(p))))
    p[int(record.count)] = 3.0
    p[int(record.steps)] = np.resize([0, 1, 2, 3, 5, 8, 2, 1], WIDTH)
    p[int(record.array[-1])] = 2.0
    p[int(record.level)] = np.resize([0.5, 1, 2, 3, 1, 1, 4, 0.1], WIDTH)
    s = rng.normal(size=(State.layout.size, WIDTH))
    w = rng.normal(size=(RESERVED + 12, WIDTH)) * 3.0
    w[RESERVED] = np.resize([0.0, -0.0, math.nan, math.inf, -7.5, 1e300, 2.5, 3.0], WIDTH)
    others = [0.0, 1.0, 2.0, -math.inf, 2.5, math.nan, 2.5, -1.0]
    w[RESERVED + 1] = [*others, *reversed(others)][:WIDTH]
    io = np.array([RESERVED, RESERVED + 1, RESERVED + 2, RESERVED + 7, RESERVED + 7], dtype=np.int64)
    io[4] = RESERVED + 8
    w = np.vstack([w, np.zeros((2, WIDTH))])
    return p, s, w, io


@pytest.mark.parametrize(("width", "lanes"), [(WIDTH, True), (WIDTH, False), (1, False)])
@pytest.mark.parametrize("step", STEPS, ids=lambda step: step.__name__)
def test_each_board_gets_the_bits_of_plain_python(step, width, lanes, arrays):
    p, s, w, io = arrays
    now = s.copy(), w.copy()
    call(step, p, *now, io, width, lanes=lanes)
    function = plain(step)
    for lane in range(WIDTH):
        own = s[:, lane].copy(), w[:, lane].copy()
        with np.errstate(all="ignore"):
            for tick in range(1, 30):
                own[1][0], own[1][1] = tick, 0.01 * tick
                function(Packed(p[:, lane].copy()), State(own[0]), Ports(own[1], io))
        for ours, oracle in zip(now, own, strict=True):
            same = (ours[:, lane] == oracle) | (np.isnan(ours[:, lane]) & np.isnan(oracle))
            assert same.all(), (lane, np.flatnonzero(~same))


def begins_anywhere(p, s, x):
    for i in range(int(p.steps), SIZE):
        s.ring[i] = 0.0


def says_too_much(p, s, x):
    x.y = sum(x.vector)


def test_what_lanes_cannot_do_runs_one_board_after_another(arrays):
    with pytest.raises(Unsupported, match="begins"):
        code.instructions(unit(begins_anywhere), WIDTH, lanes=True)
    assert "double" in code.instructions(unit(begins_anywhere), WIDTH, lanes=False)
    with pytest.raises(Unsupported, match="a call of") as raised:
        code.instructions(unit(says_too_much), 1, lanes=False)
    line = says_too_much.__code__.co_firstlineno + 1
    assert raised.value.field == f"{__file__}:{line}:11" and "calls of kernels" in raised.value.hint


@pytest.mark.parametrize(
    "other",
    [
        ("x86_64-unknown-linux-gnu", "x86-64-v2", "+sse2", "1"),
        ("x86_64-unknown-linux-gnu", "x86-64-v3", "+sse2", "1"),
        ("x86_64-unknown-linux-gnu", "x86-64-v2", "+avx", "1"),
        ("aarch64-unknown-linux-gnu", "x86-64-v2", "+sse2", "1"),
        ("x86_64-unknown-linux-gnu", "x86-64-v2", "+sse2", "2"),
    ],
)
def test_code_for_another_machine_has_another_name(other):
    here, piece = ("x86_64-unknown-linux-gnu", "x86-64-v2", "+sse2", "1"), code.step(unit(arithmetic), WIDTH)
    assert (piece.name_for(Target(*other)) == piece.name_for(Target(*here))) is (other == here)


def test_code_for_other_boards_side_by_side_has_another_name_and_is_another_file():
    class Shelf:
        def __init__(self):
            self.kept = {}
            self.get, self.put = self.kept.get, self.kept.__setitem__

    shelf = Shelf()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kernel_cache, "_shelves", [shelf])
        codes = {code.step(unit(arithmetic), width).kept() for width in (1, 8, 16)}
        assert len(codes) == len(shelf.kept) == 3
        assert {code.step(unit(arithmetic), width).kept() for width in (1, 8, 16)} == codes and len(shelf.kept) == 3
