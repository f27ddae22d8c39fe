"""Figures of the noise of a rate, from a read-out's own state."""

from __future__ import annotations

import math

import pytest

from core.readout.allan import LEVELS, Allan
from scenarios.measure.rate_noise import rate_noise_metrics

TAUS = [0.01 * 2.0**level for level in range(LEVELS)]


def state(record_s: float) -> Allan.State:
    """Return the state of a record whose noise is N 0.6 deg/rt h, B 36 deg/h, K 216 deg/h/rt h to the digit."""
    s = Allan.State.zeros()
    for level, tau in enumerate(TAUS):
        stride = max(1, 2**level // 8)
        s.averages[level] = max(0, round(record_s / 0.01) // stride + 1 - 2 * (2**level // stride))
        variance = 1e-4 / tau + 2 * math.log(2) / math.pi * 1e-4 + 1e-6 * tau / 3
        s.squares[level] = 2.0 * s.averages[level] * variance
    return s


def test_a_long_record_tells_all_three():
    assert rate_noise_metrics(TAUS, state(80_000.0)) == {
        "rate.arw_deg_per_rt_h": pytest.approx(0.6, rel=1e-6),
        "rate.noise_deg_per_h_rthz": pytest.approx(math.sqrt(2.0) * 36.0, rel=1e-6),
        "rate.bias_instability_deg_per_h": pytest.approx(36.0, rel=1e-6),
        "rate.random_walk_deg_per_h_rt_h": pytest.approx(216.0, rel=1e-6),
    }


def test_what_the_record_does_not_tell_is_left_out():
    assert set(rate_noise_metrics(TAUS, state(5.0))) == {"rate.arw_deg_per_rt_h", "rate.noise_deg_per_h_rthz"}
    assert rate_noise_metrics(TAUS, Allan.State.zeros()) == {}
