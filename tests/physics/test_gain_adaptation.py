"""The rules of appendix B on the bench, against their linear theory."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from core.errors import InputError
from core.theory.gain_adaptation import RULES, GainLoop, growth
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run
from tests.lab import make, play


def error(seconds: float = 60.0, device: str = "second-order-gain", **law: Any) -> np.ndarray:
    """Return the error under a constant of 1 V, plant of gain 1 and model of gain 2."""
    denominator = [1.0, 1.0, 1.0] if device == "second-order-gain" else [1.0, 1.0]
    board = make(
        {
            "device": {"id": device},
            "plant": {},
            "sample_rate_khz": 1,
            "model": {"kind": "transfer_function", "numerator": [2.0], "denominator": denominator},
            "reference": {"kind": "constant", "amplitude_v": 1.0},
            "controller": {"kind": "gain_adaptation", **law},
            "drive.limit_v": 1000,
            "guard.travel_um": 1000,
        }
    )
    found = play(board, round(seconds * 1000))
    assert board.trip is None
    return found["gain_adaptation.error"]


def rate(e: np.ndarray) -> float:
    quarter = len(e) // 4
    early, late = (np.abs(part).max() for part in (e[quarter : 2 * quarter], e[-quarter:]))
    return math.log(late / early) / (2 * quarter * 1e-3)


def test_mit_rule_turns_unstable_at_routh_s_limit():
    """b1/(b2 k kv R^2) = 0.5, where it swings with 2 pi sqrt(b2)."""
    below, above = error(120.0, rule="mit", adaptation_gain=0.475), error(120.0, rule="mit", adaptation_gain=0.525)
    assert np.abs(below[-10_000:]).max() < 0.5 * np.abs(below[10_000:20_000]).max()
    assert np.abs(above[-10_000:]).max() > 2.0 * np.abs(above[10_000:20_000]).max()
    rising = np.flatnonzero((above[:-1] < 0) & (above[1:] >= 0))
    assert np.diff(rising).mean() * 1e-3 == pytest.approx(2 * math.pi, abs=0.2)


@pytest.mark.parametrize(
    ("rule", "law"),
    [
        ("mit", {"adaptation_gain": 0.4}),
        ("dressler", {"adaptation_gain": 0.6}),
        ("price", {"adaptation_gain": 1.5, "proportional": 0.5}),
        ("monopoli", {"adaptation_gain": 2.0, "proportional": 0.5}),
        ("monopoli", {"adaptation_gain": 0.7, "proportional": 0.0}),
        ("lyapunov", {"adaptation_gain": 0.5}),
    ],
)
def test_every_rule_settles_at_the_rate_of_its_eigenvalues(rule, law):
    loop = GainLoop(model_gain=2.0, error_weight=0.5, proportional=law.get("proportional", 0.5))
    theory = growth(loop, RULES[rule], law["adaptation_gain"], 0.0)
    assert theory < 0
    assert rate(error(40.0, rule=rule, **law)) == pytest.approx(theory, rel=0.12, abs=0.005)


def test_parks_as_derived_stops_short_and_the_corrected_rule_does_not():
    """On the slope alone the integral of e' r is e r: e settles at kR/(1 + kv B R^2) = 2/1.5."""
    assert error(rule="lyapunov", form="derived", adaptation_gain=0.5)[-1] == pytest.approx(4 / 3, abs=0.01)
    assert abs(error(120.0, rule="lyapunov", adaptation_gain=0.5)[-1]) < 1e-6


def test_as_printed():
    # B.1.1 without its dot: kc = B e ym with ym = 2, so e = 2 - 2 B e
    assert error(rule="mit", form="printed", adaptation_gain=0.1)[-1] == pytest.approx(2 / 1.2, abs=1e-3)
    # with e for e' it is Dressler's rule
    np.testing.assert_array_equal(
        error(10.0, rule="lyapunov", form="printed", adaptation_gain=0.7),
        error(10.0, rule="dressler", adaptation_gain=0.7),
    )


def test_first_order_is_stable_at_any_gain():
    for rule in ("mit", "dressler", "price"):
        assert abs(error(30.0, "first-order-gain", rule=rule, adaptation_gain=5.0)[-1]) < 1e-4


def test_study_needs_its_controller_and_follows_its_parameters():
    with pytest.raises(InputError, match=r"controller\.kind"):
        run(with_values(get("appB-mit"), {"controller": {"kind": "open_loop"}}))
    noisy = run(with_values(get("appB-mit"), {"sensor.noise_um": 0.02, "study.frequencies": []})).metrics
    assert noisy["adaptation.period_s"] == pytest.approx(2 * math.pi, abs=0.2)
    assert noisy["adaptation.growth_per_s"] == pytest.approx(noisy["adaptation.growth_theory_per_s"], abs=0.002)
    half = run(with_values(get("appB-mit"), {"reference.amplitude_v": 2.0, "study.frequencies": []}))
    assert half.metrics["adaptation.critical_gain"] == pytest.approx(0.125, rel=1e-3)
