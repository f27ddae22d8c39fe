"""The C of a step gives the bits of its machine code."""

from __future__ import annotations

import ctypes
import math

import numpy as np
import pytest

from scenarios.speed.anchor.compiler import compiler, library
from scenarios.speed.anchor.difference import same
from scenarios.speed.anchor.expressions import literal
from scenarios.speed.anchor.text import ARGUMENTS, translated
from scenarios.speed.anchor.writer import HEAD, Writer
from tests.core.compile.test_translate import STEPS, WIDTH, Packed, arrays, call, unit

__all__ = ["arrays"]
TICKS = range(1, 30)


def numbers_known(p, io):
    """Return the numbers of a step that never change, of the count, the length of the tails and the ports."""
    choices = {("p", next(field.offset for field in Packed.layout.fields if field.name == "count")): 3.0}
    return choices | {("io", place): int(signal) for place, signal in enumerate(io)}


@pytest.mark.skipif(compiler() is None, reason="there is no gcc on this machine")
@pytest.mark.parametrize("known", [False, True], ids=["read", "constant"])
def test_the_c_of_each_step_gives_the_bits_of_its_machine_code(arrays, known, tmp_path):
    p, s, w, io = arrays
    found, texts = {}, []
    for step in STEPS:
        writer = Writer(translated(unit(step)).functions[0], numbers_known(p, io) if known else {}, found)
        texts.append(writer.text(f"step_{step.__name__}", ARGUMENTS))
        passed = "double *p, double *s, double *w, int64_t *io"
        texts.append(f"void {step.__name__}({passed}) {{ step_{step.__name__}(p, s, w, io); }}")
    made = library(str(compiler()), "\n".join([HEAD, *found.values(), *texts]), tmp_path)
    for step in STEPS:
        ours = s.copy(), w.copy()
        call(step, p, *ours, io, 1, lanes=False)
        for board in range(WIDTH):
            own = [np.ascontiguousarray(part[:, board]) for part in (p, s, w)]
            for tick in TICKS:
                own[2][:2] = tick, 0.01 * tick
                getattr(made, step.__name__)(*(ctypes.c_void_p(part.ctypes.data) for part in (*own, io)))
            for theirs, one in zip(own[1:], ours, strict=True):
                assert same(theirs, one[:, board]), (step.__name__, board)


@pytest.mark.parametrize("value", [0.0, -0.0, 0.1, -3.5e-310, 1e300, math.inf, -math.inf])
def test_a_constant_of_c_has_all_bits_of_the_number(value):
    text = literal(value, "double")
    if math.isinf(value):
        assert text == ("(-__builtin_inf())" if value < 0.0 else "(__builtin_inf())")
    else:
        back = float.fromhex(text.strip("()"))
        assert math.copysign(1.0, back) == math.copysign(1.0, value) and back == value


def test_a_constant_of_c_may_be_no_number_or_a_whole_number():
    assert literal(math.nan, "double") == '__builtin_nan("")'
    assert [literal(value, "i64") for value in (7, 2**64 - 1, 2**63)] == ["INT64_C(7)", "INT64_C(-1)", "INT64_MIN"]
    assert [literal(value, "i1") for value in (-1, 1, 0)] == ["1", "1", "0"]
