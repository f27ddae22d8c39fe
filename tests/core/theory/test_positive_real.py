"""Verdicts on transfer functions against textbook cases and against a grid of the definition itself."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import signal

from core.errors import InputError
from core.theory.positive_real import nyquist, positive_real

A1 = 7.09e-7 / math.sqrt(0.0538 * 2.2090e-10)
LCR = [1.0, A1, 1.0]

CASES = [
    # (s + c)/((s + 2)(s + 3)) has Re > 0 and falls as 1/w^2 for c < 5, as 1/w^4 at c = 5, and is negative far out above
    ([1, 1], [1, 5, 6], "strict"),
    ([1, 4.9], [1, 5, 6], "strict"),
    ([1, 5], [1, 5, 6], "positive"),
    ([1, 6], [1, 5, 6], "no"),
    ([1], LCR, "no"),
    ([1, 0], LCR, "positive"),
    ([1, 0.9 * A1], LCR, "strict"),
    ([1], [1, 0], "positive"),
    ([1], [1, 0, 0], "no"),
    ([1, 0], [1, 0, 1], "positive"),
    ([1], [1, 0, 1], "no"),
    ([-1, 0], [1, 0, 1], "no"),
    ([1, 0, 1], [1, 0, 4, 0], "positive"),  # poles 0 and 2j, residues 1/4 and 3/8
    ([1, 0, 9], [1, 0, 4, 0], "no"),  # the residue at 2j is negative
    ([1], [1, 1], "strict"),
    ([2], [2, -0.4], "no"),
    ([3], [1], "strict"),
    ([-1], [1, 1], "no"),
    ([1, 2], [1, 1], "strict"),
    ([1, 0], [1, 1], "positive"),
    ([1, 1], [1], "strict"),
    ([1, 1, 1], [1, 1], "positive"),  # s + 1/(s + 1): the real part vanishes far out
    ([1, 2, 2], [1, 1], "strict"),  # s + 1 + 1/(s + 1)
]


def word(n, d) -> str:
    found = positive_real(n, d)
    return "strict" if found.strictly_positive_real else "positive" if found.positive_real else "no"


@pytest.mark.parametrize(("numerator", "denominator", "verdict"), CASES)
def test_textbook_cases(numerator, denominator, verdict):
    assert word(numerator, denominator) == verdict
    assert word([7 * value for value in numerator], [0.3 * value for value in denominator]) == verdict
    found = positive_real(numerator, denominator)
    assert bool(found.reasons) == (verdict != "strict")
    assert not found.strictly_positive_real or found.positive_real


def by_definition(n, d, shift: float) -> bool:
    """Whether G(s - shift) is positive real, on a grid: Re G >= 0 on the line Re s = -shift, no pole right of it."""
    w = np.concatenate([[0.0], np.logspace(-4, 5, 4000)])
    s = -shift + 1j * w
    values = np.polyval(n, s) / np.polyval(d, s)
    return bool(np.all(np.roots(d).real < -shift) and values.real.min() >= -1e-12)


def test_random_ones_agree_with_the_definition_on_a_grid():
    rng = np.random.default_rng(7)
    seen = {True: 0, False: 0}
    for _ in range(400):
        poles, zeros = -rng.uniform(0.2, 4.0, 3), -rng.uniform(0.2, 4.0, rng.integers(2, 4))
        n, d = np.poly(zeros), np.poly(poles)
        found = positive_real(n, d).strictly_positive_real
        assert found == by_definition(n, d, 1e-6), (n, d)
        seen[found] += 1
    assert min(seen.values()) > 30


def test_smallest_real_part_and_nyquist_against_scipy():
    n, d = [1.0, 6.0], [1.0, 5.0, 6.0]
    w = np.logspace(-2, 3, 200_000)
    _, response = signal.freqs(n, d, w)
    found = positive_real(n, d)
    assert found.least_real == pytest.approx(response.real.min(), rel=1e-6)
    assert found.at == pytest.approx(w[np.argmin(response.real)], rel=1e-3)
    real, imaginary = nyquist(n, d, w)
    np.testing.assert_allclose(real + 1j * imaginary, response, rtol=1e-9)
    assert math.isinf(positive_real([1, 1], [1, 5, 6]).at)


def test_properties_of_a11():
    """1/G, positive sums and the feedback loop of strictly positive real functions are strictly positive real."""
    n1, d1, n2, d2 = [1, 1], [1, 5, 6], [1, 2], [1, 1]
    assert word(d1, n1) == word(d2, n2) == "strict"
    assert word(np.polyadd(np.polymul(2 * np.array(n1), d2), np.polymul(n2, d1)), np.polymul(d1, d2)) == "strict"
    assert word(np.polymul(n1, d2), np.polyadd(np.polymul(d1, d2), np.polymul(n1, n2))) == "strict"


@pytest.mark.parametrize(
    ("n", "d", "field"), [([0.0], [1.0], "numerator"), ([1.0], [math.inf], "denominator"), ([1.0] * 30, [1.0], "numer")]
)
def test_what_is_no_transfer_function_is_refused(n, d, field):
    with pytest.raises(InputError) as error:
        positive_real(n, d)
    assert error.value.field.startswith(field)
