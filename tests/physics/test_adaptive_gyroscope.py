"""Adaptive control of two axes against the laws written out in matrices, and what excitation tells."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from core.device.catalogue import device
from scenarios.run import RunResult, run
from scenarios.schema import Scenario

S = np.array([[0.0, -1.0], [1.0, 0.0]])
RAD = 180.0 / math.pi
"""deg/s of 1 rad/s."""
SLOW = {"frequency_x_hz": 663.676, "frequency_y_hz": 813.282}


def bench(kind: str, name: str, ms: float, khz: float, rates: tuple[float, float], **law: Any) -> RunResult:
    """Run an adaptive controller with a rate that steps in the middle, rad/s."""
    first, second = (RAD * rate for rate in rates)
    points = [{"at_ms": 0.5 * ms, "deg_per_s": first}, {"at_ms": 0.5 * ms + 1e-3, "deg_per_s": second}]
    document = {
        "schema": 1,
        "sample_rate_khz": khz,
        "duration_ms": ms,
        "device": {"id": name},
        "plant": {"model": "gyroscope", "thermal_noise": False},
        "rate": {"kind": "profile", "points": points},
        "controller": {"kind": kind, **law},
    }
    return run(Scenario.load(document))


def matrices(name: str) -> tuple[float, np.ndarray, np.ndarray]:
    """Return mass in mg, damping and stiffness per mass in 1/ms and 1/ms^2."""
    d = device({"id": name}).gyroscope
    assert d is not None
    o = d.two_axis()
    return o.mass, o.dampings / o.mass, o.stiffnesses / o.mass


def sym(a: np.ndarray) -> np.ndarray:
    return 0.5 * (a + a.T)


def written_out(kind: str, name: str, n: int, h: float, omega: float, hz: tuple[float, float]) -> np.ndarray:
    """Return the rate that the law reads, rad/s, sample by sample; the plant by matrix exponentials."""
    _, damping, stiffness = matrices(name)
    natural = math.sqrt(stiffness[0, 0])
    slow = kind == "adaptive_rate"
    unit = 1.0 if slow else 1.0 / natural
    gamma, gk, gd, go = (1.061 * natural, 1.125 * natural**2, 2.0, 1.0) if slow else (1.0, 1.0, 0.1, 0.04)
    size = np.array([1.0, 1.2] if slow else [1.0, 1.0])
    a = np.zeros((6, 6))
    a[:2, 2:4] = np.eye(2)
    a[2:4] = np.hstack([-stiffness, -damping - 2e-3 * omega * S, np.eye(2)])
    step = expm(a * h)
    q, v, tau, before = np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2)
    k, d, skew, rate, read = np.zeros((2, 2)), np.zeros((2, 2)), 0.0, 0.0, 0.0
    w = 2e-3 * math.pi * np.array(hz)
    km = np.diag((w * unit) ** 2)
    larger = (w * h / 2) / np.sin(w * h / 2)
    told = np.empty(n)
    for i in range(n):
        if i:
            x = step @ np.concatenate([q, v, tau])
            q, v = x[:2], x[2:4]
        qm, vm = size * np.sin(w * h * i), size * w * unit * np.cos(w * h * i)
        slope = (k + skew * S - km) @ vm - (d + 2 * rate * S) @ km @ qm
        e = unit * v - vm + (h / unit) ** 2 / 12 * slope
        by, by_v = (qm, vm) if slow else (q, vm + e)
        k = k - gk * h / unit * sym(np.outer(e, by))
        d = d - gd * h / unit * sym(np.outer(e, by_v))
        skew -= 0.5 * gk * h / unit * float(e @ S @ by)
        rate -= go * h / unit * float(e @ S @ by_v)
        ahead = w * h * (i + 0.5)
        by, by_v = larger * size * np.sin(ahead), larger * size * w * unit * np.cos(ahead)
        if not slow:
            by, by_v, before = by + 1.5 * (q - qm) - 0.5 * before, by_v + e, q - qm
        tau = ((k + skew * S - km) @ by + d @ by_v + 2 * rate * S @ by_v - gamma * e) / unit**2
        read += (1.0 - math.exp(-2e-3 * math.pi * 30.0 * h)) * (rate - read)
        told[i] = 1e3 * read / unit
    return told


@pytest.mark.parametrize("khz", [100.0, 250.0])
@pytest.mark.parametrize(("kind", "name"), [("adaptive_rate", "gyro-a"), ("mimo_adaptive", "gyro-4-5")])
def test_the_estimate_is_that_of_the_law(kind, name, khz):
    hz = (663.676, 813.282) if kind == "adaptive_rate" else (3000.0, 3900.0)
    n = 4000
    result = bench(kind, name, n / khz, khz, (40.0, 40.0), frequency_x_hz=hz[0], frequency_y_hz=hz[1])
    told = result.signal(f"{kind}.rate") / RAD
    expected = written_out(kind, name, n, 1 / khz, 40.0, hz)
    np.testing.assert_allclose(told, expected, atol=1e-6 * np.abs(expected).max())


def test_rate_of_slow_references():
    """Set A at 100 kHz: both rates within 0.001 %, 5 % in about 98 and 23 ms."""
    found = bench("adaptive_rate", "gyro-a", 1000, 100, (100.0, 200.0), **SLOW).metrics
    assert found["rate.error_pct.1"] == pytest.approx(0.0, abs=0.001)
    assert found["rate.error_pct.2"] == pytest.approx(0.0, abs=0.001)
    assert found["rate.settling_ms.1"] == pytest.approx(98, abs=10)
    assert found["rate.settling_ms.2"] == pytest.approx(22.5, abs=2)
    assert found["gyro.trusted"] == 1.0


@pytest.mark.parametrize(
    ("gains", "stops"),
    [
        ({"cross_gain": 20.0, "rate_gain": 10.0}, False),
        ({"cross_gain": 800.0, "rate_gain": 400.0}, True),
        ({"stiffness_gain": 4e4}, True),
        ({"velocity_gain": 200.0}, True),
    ],
)
def test_gains_that_diverge_stop_the_bench(gains, stops):
    result = bench("adaptive_rate", "gyro-a", 1000, 100, (100.0, 100.0), **SLOW, **gains)
    assert (result.trip is not None) == stops
    if not stops:
        assert result.metrics["rate.error_pct"] == pytest.approx(0.0, abs=5.0)


@pytest.mark.long
def test_rate_of_slow_references_at_1_mhz():
    found = bench("adaptive_rate", "gyro-a", 1000, 1000, (100.0, 200.0), **SLOW).metrics
    assert found["rate.error_pct.1"] == pytest.approx(0.0, abs=1e-4)
    assert found["rate.error_pct.2"] == pytest.approx(0.0, abs=1e-4)
    assert found["rate.settling_ms.1"] == pytest.approx(98.5, abs=1)  # as at 100 kHz
    assert found["rate.settling_ms.2"] == pytest.approx(22.5, abs=1)


@pytest.mark.parametrize("hz", [663.676, 800.0])
def test_one_frequency_follows_and_does_not_tell_the_rate(hz):
    result = bench("adaptive_rate", "gyro-a", 1000, 100, (100.0, 200.0), frequency_x_hz=hz, frequency_y_hz=hz)
    assert result.metrics["gyro.trusted"] == 0.0
    assert abs(result.metrics["rate.error_pct.1"]) > 20.0 and abs(result.metrics["rate.error_pct.2"]) > 20.0
    asked = 1.2 * np.sin(2e-3 * math.pi * hz * 0.01 * np.arange(100_000))
    assert np.abs(result.signal("plant.y") - asked)[-20_000:].max() < 0.02


@pytest.mark.parametrize("apart", [0.0, 0.2, 5.0, -9.0, 30.0, -50.0])
def test_frequencies_that_hardly_differ_are_not_trusted(apart):
    """While the estimates swing with a slow beat, 100 rad/s is read as thousands; it is trusted when that is over."""
    hz = {"frequency_x_hz": 663.676, "frequency_y_hz": 663.676 + apart}
    result = bench("adaptive_rate", "gyro-a", 2200, 100, (100.0, 100.0), **hz)
    told, trusted = result.signal("adaptive_rate.rate") / RAD, result.signal("adaptive_rate.trusted") != 0.0
    assert np.abs(told[20_000:60_000] - 100.0).max() > 20.0
    np.testing.assert_allclose(told[trusted], 100.0, atol=15.0)
    assert trusted[-1] == (abs(apart) > 20.0)
    assert any("not persistently exciting" in text for text in result.warnings) == (abs(apart) < 10.0)


@pytest.mark.parametrize("rate", [0.0, 100.0])
def test_who_takes_over_has_to_learn_before_it_is_trusted(rate):
    document = {
        "duration_ms": 400,
        "device": {"id": "gyro-a"},
        "plant": {"model": "gyroscope", "thermal_noise": False},
        "rate": {"kind": "constant", "deg_per_s": RAD * rate},
        "controllers": {"adaptive_rate": SLOW},
        "controller": {"kind": "open_loop_rate"},
        "events": [{"at_ms": 60.0, "switch": "adaptive_rate"}],
    }
    result = run(Scenario.load(document))
    told, trusted = result.signal("adaptive_rate.rate") / RAD, result.signal("adaptive_rate.trusted") != 0.0
    assert not trusted[:7000].any() and trusted[-1] == (rate != 0.0)
    np.testing.assert_allclose(told[trusted], rate, atol=15.0)
    bound = result.signal("adaptive_rate.bound")
    assert (bound[:7000] == 1e6).all() and RAD * abs(told[-1] - rate) < bound[-1] < 30.0


@pytest.mark.parametrize("name", ["gyro-4-5", "gyro-2-2", "gyro-a"])
def test_many_inputs(name):
    """5 and 10 rad/s within 2 %, 5 % in less than 40 ms."""
    found = bench("mimo_adaptive", name, 300, 1000, (5.0, 10.0)).metrics
    for number in (1, 2):
        assert found[f"rate.error_pct.{number}"] == pytest.approx(0.0, abs=0.5)
        assert found[f"rate.settling_ms.{number}"] < 40.0
    assert found["gyro.trusted"] == 1.0
    same = bench("mimo_adaptive", name, 300, 1000, (5.0, 10.0), frequency_x_hz=3000.0, frequency_y_hz=3000.0).metrics
    assert same["gyro.trusted"] == 0.0 and abs(same["rate.error_pct.2"]) > 20.0
