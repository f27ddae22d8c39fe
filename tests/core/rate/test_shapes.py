"""Angular rates against their formulas."""

from __future__ import annotations

from fractions import Fraction
from math import pi, sin
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from core import registry
from tests.rates import Row

DT = 0.01
T = np.arange(3000) * DT


def rate(kind: str, ticks: int = 3000, every: int = 1, **values: Any) -> np.ndarray:
    played = Row(("rate", kind, values), dt_ms=DT, every=every).play(ticks)
    assert np.array_equal(played[:, 0], played[:, 1])  # without noise the rate is the one commanded
    return played[:, 0]


def test_constant_and_step():
    assert np.all(rate("constant", deg_per_s=-3.5) == -3.5)
    assert np.array_equal(rate("step", deg_per_s=20.0, start_ms=1.5), np.where(np.arange(3000) >= 150, 20.0, 0.0))


@pytest.mark.parametrize(("hz", "phase"), [(100.0, 0.0), (333.3, 77.0), (0.0, 90.0), (20.0, -400.0)])
def test_sine(hz, phase):
    expected = 7.0 * np.sin(2 * np.pi * hz * T / 1e3 + np.radians(phase))
    np.testing.assert_allclose(rate("sine", deg_per_s=7.0, frequency_hz=hz, phase_deg=phase), expected, atol=1e-11)


def test_sine_is_exact_after_hours():
    row = Row(("rate", "sine", {"deg_per_s": 1.0, "frequency_hz": 1000.0}), dt_ms=DT)
    row.tick = 36_000_000_017  # 100 h at 100 kHz
    cycles = float(Fraction(row.tick, 100) % 1)
    assert row.play(1)[0, 0] == pytest.approx(sin(2 * pi * cycles), abs=1e-6)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 17])
def test_profile_is_linear_between_its_points(count):
    rng = np.random.default_rng(count)
    times = np.cumsum(rng.uniform(0.05, 30.0 / count, count))
    rates = rng.uniform(-300.0, 300.0, count)
    points = [{"at_ms": t, "deg_per_s": r} for t, r in zip(times, rates, strict=True)]
    np.testing.assert_allclose(rate("profile", points=points), np.interp(T, times, rates), atol=1e-10)


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([], "at least one point"),
        ([{"at_ms": 1.0}, {"at_ms": 1.0}], "must rise in at_ms, got 1 after 1"),
        ([{"at_ms": 2.0}, {"at_ms": 1.0}], "must rise in at_ms, got 1 after 2"),
        ([{"at_ms": -2.0}], "greater than or equal to 0"),
    ],
)
def test_points_that_do_not_rise_are_refused(points, said):
    with pytest.raises(ValidationError, match=said):
        registry.block("rate", "profile").Params(points=points)


@pytest.mark.parametrize("every", [2, 7])
def test_a_rate_that_runs_every_few_ticks_is_held_between_them(every):
    each = rate("sine", 500, frequency_hz=70.0)
    np.testing.assert_array_equal(rate("sine", 500, every, frequency_hz=70.0), each[np.arange(500) // every * every])


@pytest.mark.parametrize("kind", sorted(registry.blocks("rate")))
def test_compiled_rates_have_the_bits_of_plain_python(kind):
    noise = {"angle_random_walk_deg_rt_h": 0.3, "bias_instability_deg_h": 20.0, "rate_random_walk_deg_h_rt_h": 50.0}
    for every in (1, 3):
        fast, slow = (
            Row(("rate", kind, noise), dt_ms=DT, every=every, compiled=compiled) for compiled in (True, False)
        )
        assert np.array_equal(fast.play(1500), slow.play(1500))
        assert np.array_equal(fast.s[0], slow.s[0])
