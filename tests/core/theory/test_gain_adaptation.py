"""Stability of the gain rules against Routh's criterion and against an integrator of another kind."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from core.theory.gain_adaptation import (
    DRESSLER,
    LYAPUNOV,
    MIT,
    MONOPOLI,
    PARKS,
    PRICE,
    RULES,
    GainLoop,
    critical_gain,
    growth,
    instability_map,
    monodromy,
)

LOOP = GainLoop(b1=0.7, b2=1.3, gain=1.2, model_gain=2.0, amplitude=0.9)
K = 1.2 * 0.9**2


@pytest.mark.parametrize(
    ("rule", "loop", "limit"),
    [
        # b2 s^3 + b1 s^2 + ... = 0 is stable while b1 times the third coefficient exceeds b2 times the last
        (MIT, LOOP, 0.7 / (1.3 * 2.0 * K)),
        (DRESSLER, LOOP, 0.7 / (1.3 * K)),
        (PRICE, GainLoop(0.7, 1.3, 1.2, 2.0, 0.9, proportional=1.0), 0.7 / (1.3 * K - 0.7 * K)),
        (MONOPOLI, GainLoop(0.7, 1.3, 1.2, 2.0, 0.9, proportional=0.0, filter_time=1.0), 0.7 / (1.3 * K - 0.7 * K)),
        (LYAPUNOV, GainLoop(0.7, 1.3, 1.2, 2.0, 0.9, error_weight=0.8), 0.7 / (1.3 * 0.8 * K - 0.7 * K)),
    ],
)
def test_limits_under_a_constant_are_those_of_routh(rule, loop, limit):
    assert critical_gain(loop, rule, 0.0, most=20.0) == pytest.approx(limit, rel=1e-3)


@pytest.mark.parametrize(
    ("rule", "loop"),
    [
        (PRICE, GainLoop(0.7, 1.3, proportional=1.3 / 0.7)),
        (MONOPOLI, GainLoop(0.7, 1.3, proportional=0.0, filter_time=1.01 * 1.3 / 0.7)),
        (MONOPOLI, GainLoop(0.7, 1.3, proportional=2.0, filter_time=1.01 * 1.3 / 0.7)),
        (LYAPUNOV, GainLoop(0.7, 1.3, error_weight=0.99 * 0.7 / 1.3)),
        (PARKS, GainLoop(0.7, 1.3)),
    ],
)
def test_rules_that_are_stable_for_every_gain(rule, loop):
    assert critical_gain(loop, rule, 0.0, most=1e3) == 1e3


def law(rule: int, loop: GainLoop, rate: float, w: float):
    """Model, filter, plant and rule as four separate equations, nothing periodic put in."""

    def slope(t, state):
        e, v, x, ym, dym, y = state
        r = loop.amplitude * math.sin(w * t)
        ym_slope = (loop.model_gain * r - ym - loop.b1 * dym) / loop.b2
        y_slope = (r - y) / loop.filter_time
        error = {MIT: e * ym, DRESSLER: e * r, PRICE: e * r, PARKS: v * r, MONOPOLI: e * y}
        kc = rate * error.get(rule, (v + loop.error_weight * e) * r)
        if rule == MONOPOLI:
            kc += loop.proportional * rate * (v * y + e * y_slope)
        gain_error = x - (loop.gain * loop.proportional * rate * e * r if rule == PRICE else 0.0)
        drive = gain_error * r - (loop.filter_time * loop.gain * kc * y if rule == MONOPOLI else 0.0)
        return [v, (drive - loop.b1 * v - e) / loop.b2, -loop.gain * kc, dym, ym_slope, y_slope]

    return slope


@pytest.mark.parametrize("rule", RULES.values(), ids=RULES)
def test_transition_over_a_period_is_that_of_the_whole_loop(rule):
    loop, rate, w = GainLoop(0.4, 1.1, 1.3, 1.7, 0.8, 0.3, 0.9, 1.2), 0.35, 0.9
    s, size = 1j * w, 0.8
    model = 1.7 * size / (1.1 * s * s + 0.4 * s + 1)
    filtered = size / (1 + 1.2 * s)
    found = monodromy(loop.packed(), rule, rate, w)
    for column in range(3):
        # a sine is the imaginary part; the steady state starts at the phasor's value
        start = [*np.eye(3)[column], model.imag, (model * s).imag, filtered.imag]
        exact = solve_ivp(law(rule, loop, rate, w), (0, 2 * math.pi / w), start, rtol=1e-10, atol=1e-12)
        np.testing.assert_allclose(found[:, column], exact.y[:3, -1], rtol=2e-6, atol=2e-6)


def test_tongues_of_the_mit_rule_and_of_dressler():
    """b1 = 0.2: figures of an independent Floquet computation."""
    loop = GainLoop(b1=0.2, error_weight=0.1, filter_time=6.0)
    for w, limit in ((0.5, 0.24), (0.8, 0.105), (1.2, 0.17), (1.5, 0.73)):
        assert critical_gain(loop, MIT, w, most=1.0, points=50) == pytest.approx(limit, abs=0.006)
    for w in (1.2, 1.5):  # above resonance the plant turns the sign of the error
        assert growth(loop, DRESSLER, 0.01, w) > 0 > growth(loop, MIT, 0.01, w)
    for rule in (LYAPUNOV, MONOPOLI):
        # with gamma as without it: the plant behind the filter is positive real
        assert all(growth(loop, rule, rate, w) <= 1e-7 for w in (0.5, 0.8, 1.2) for rate in (0.1, 1.0, 30.0))


def test_map_rows_are_frequencies():
    loop = GainLoop(b1=0.2)
    found = instability_map(loop, MIT, np.array([0.05, 0.15]), np.array([0.5, 0.8, 1.5]))
    assert found.shape == (3, 2)
    assert found[1, 1] > 0 > max(found[1, 0], found[0, 1], found[2, 1])


def test_what_grows_beyond_any_number_grows_fast():
    fierce = GainLoop(0.01, 1.0, 100.0, 100.0, 100.0)
    rate, w = 1e3, 0.01
    assert not np.all(np.isfinite(monodromy(fierce.packed(), MIT, rate, w)))
    assert growth(fierce, MIT, rate, w) == pytest.approx(709.78 * w / (2.0 * math.pi), rel=1e-4)
