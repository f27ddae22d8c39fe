"""Elementary functions against mpmath at 160 bits: within one unit in the last place, compiled as in plain Python."""

from __future__ import annotations

import math
import struct

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core import elementary
from core.compile import entry
from core.compile.machine import improved, machine, native
from core.elementary.bits import bits_of, number_of, product_error, sum_error
from core.kernel import kernel
from core.plain import plain

BITS = 160
LONGEST = 2**20 * math.pi / 2


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high)


def turn_sine(turns: mpmath.mpf) -> mpmath.mpf:
    return mpmath.sinpi(2 * turns)


FUNCTIONS = {
    "exp": (elementary.exp, mpmath.exp, (-745.0, 709.78)),
    "log": (elementary.log, mpmath.log, (5e-324, 1.7e308)),
    "sin": (elementary.sin, mpmath.sin, (-LONGEST, LONGEST)),
    "cos": (elementary.cos, mpmath.cos, (-LONGEST, LONGEST)),
    "sin_of_turns": (elementary.sin_of_turns, turn_sine, (-(2.0**40), 2.0**40)),
    "tanh": (elementary.tanh, mpmath.tanh, (-800.0, 800.0)),
}


def ulps(ours: float, exact: mpmath.mpf) -> float:
    """Distance in units in the last place of the exact value."""
    return float(abs(mpmath.mpf(ours) - exact) / math.ulp(float(exact)))


def held(name: str, x: float) -> None:
    ours, exact, _ = FUNCTIONS[name]
    with mpmath.workprec(BITS):
        value = exact(mpmath.mpf(x))
        assert ulps(ours(x), value) <= 1.0, (name, x)
    assert struct.pack("<d", plain(ours)(x)) == struct.pack("<d", ours(x)), (name, x)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_within_one_unit_in_the_last_place(name):
    @given(numbers(*FUNCTIONS[name][2]))
    def any_number(x):
        held(name, x)

    @given(numbers(-4.0, 4.0).filter(lambda x: name != "log" or x > 0.0))
    def usual_number(x):
        held(name, x)

    any_number()
    usual_number()


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_thousand_draws_of_each(name):
    low = FUNCTIONS[name][2][0]
    generator = np.random.default_rng(7)
    near = generator.uniform(max(low, 1e-3 if name == "log" else -8.0), 8.0, 1000)
    for x in near:
        held(name, float(x))


@pytest.mark.parametrize("name", ["sin", "cos"])
@given(k=st.integers(-(2**19), 2**19), off=st.integers(-3, 3))
def test_beside_the_zeros_of_sine_and_cosine(name, k, off):
    x = k * math.pi / 2
    for _ in range(abs(off)):
        x = math.nextafter(x, math.copysign(math.inf, off))
    held(name, x)


@given(y=numbers(-1e300, 1e300), x=numbers(-1e300, 1e300))
def test_angles_of_points(y, x):
    held_angle(y, x)


@given(turn=numbers(-math.pi, math.pi), size=st.integers(-900, 900))
def test_angles_all_around(turn, size):
    held_angle(math.ldexp(math.sin(turn), size), math.ldexp(math.cos(turn), size))


@given(numbers(-60.0, 709.0) | numbers(-0.5, 0.5))
def test_exponential_less_one(x):
    with mpmath.workprec(BITS):
        assert ulps(elementary.expm1(x), mpmath.expm1(x)) <= 1.1, x


def held_angle(y: float, x: float) -> None:
    ours = elementary.atan2(y, x)
    assert plain(elementary.atan2)(y, x) == ours
    if x == 0.0 and y == 0.0:
        assert ours == 0.0
        return
    with mpmath.workprec(1200):  # the quotient of two numbers far apart
        exact = mpmath.atan2(mpmath.mpf(y), mpmath.mpf(x))
        assert ulps(ours, exact) <= 1.0, (y, x)


def test_edges():
    inf, nan = math.inf, math.nan
    e = elementary
    assert (e.exp(0.0), e.exp(-inf), e.exp(inf), e.exp(710.0), e.exp(-746.0)) == (1.0, 0.0, inf, inf, 0.0)
    assert (e.log(1.0), e.log(0.0), e.log(inf)) == (0.0, -inf, inf)
    assert (e.tanh(inf), e.tanh(-inf), e.sin(0.0), e.cos(0.0)) == (1.0, -1.0, 0.0, 1.0)
    assert all(math.isnan(f(nan)) for f in (e.exp, e.log, e.sin, e.cos, e.tanh))
    assert all(math.isnan(value) for value in (e.log(-1.0), e.log(-inf), e.sin(inf), e.cos(inf)))
    for f in (e.sin, e.tanh):
        assert math.copysign(1.0, f(-0.0)) == -1.0
    assert [e.sin_of_turns(0.25 * k) for k in range(-4, 5)] == [0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, -1.0, 0.0]
    pi = math.pi
    assert (e.atan2(1.0, 0.0), e.atan2(-1.0, 0.0), e.atan2(0.0, -1.0)) == (pi / 2, -pi / 2, pi)
    assert (e.atan2(1.0, 1.0), e.atan2(-1.0, -1.0)) == (pi / 4, -3 * pi / 4)


def test_bits_go_there_and_back():
    @kernel
    def there_and_back(value):
        return number_of(bits_of(value))

    @given(st.floats(allow_nan=False))
    def any_number(x):
        assert bits_of(x) == struct.unpack("<q", struct.pack("<d", x))[0]
        assert number_of(bits_of(x)) == there_and_back(x) == x

    any_number()


sized = numbers(1e-130, 1e130) | numbers(-1e130, -1e-130)


@given(sized, sized)
def test_errors_of_sums_and_products_are_exact(a, b):
    with mpmath.workprec(2200):
        assert mpmath.mpf(a) + mpmath.mpf(b) == mpmath.mpf(a + b) + sum_error(a, b, a + b)
        assert mpmath.mpf(a) * mpmath.mpf(b) == mpmath.mpf(a * b) + product_error(a, b, a * b)


def test_a_loop_of_them_becomes_vector_code():
    """The point of having no branch and no call: several at once in the registers of the processor."""
    f = elementary.exp

    @kernel
    def all_of(x, out):
        for i in range(len(x)):
            out[i] = f(x[i])

    vector = "float64", 1, True
    text = entry.instructions(all_of.py_func, (vector, vector))
    code = machine(native()).emit_assembly(improved(text, native(), loops=True))
    assert "vmulpd" in code or "mulpd" in code
    assert "callq\texp" not in code and "call\texp" not in code
