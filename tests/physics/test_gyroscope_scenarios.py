"""What library scenarios of gyroscopes claim, computed beside them: diagnosis, three noises, force off resonance."""

from __future__ import annotations

import math

import numpy as np
import pytest

from scenarios.library import get
from scenarios.run import run
from scenarios.schema import Scenario

DEG_H, DEG_RT_H = 1.0 / 3600.0, 1.0 / 60.0
"""deg/h in deg/s, deg/rt h in deg/rt s."""


@pytest.mark.parametrize("seed", [2, 5])
def test_the_bank_says_what_is_there(seed):
    """The truth is written here once more, from the events; 2 ms are given to each change, and a grace of 0.5 %."""
    result = run(get("gyro-diagnosis"), seed, taps=True)
    ms = np.arange(180_000) * 0.01
    there = [(250.0, 450.0, 1.0), (600.0, 850.0, 2.0), (1000.0, 1250.0, 3.0), (1400.0, 1800.0, 4.0)]
    truth, changes = np.zeros(len(ms)), [0.0, 700.0]
    for start, end, number in there:
        truth[(ms >= start) & (ms < end)] = number
        changes += [start, end]
    settled = (ms < 200.0) | (ms >= 250.0)
    for change in changes:
        settled &= (ms < change) | (ms >= change + 2.0)
    assert (result.signal("bank.winner") == truth)[settled].mean() > 0.995
    assert result.signal("bank.rate.damping-x2")[-1] == pytest.approx(300.0, abs=8.0)
    assert result.metrics["diagnosis.bank.missed_steps"] == 0.0


@pytest.mark.long
@pytest.mark.parametrize("seed", [3, 8])
def test_an_allan_deviation_has_three_branches(seed):
    """N^2/tau + (2 ln 2/pi) B^2 + K^2 tau/3 at every octave, within three deviations of its own scatter."""
    result = run(get("gyro-allan-three-noises"), seed)
    white, floor, walk = 0.9 * DEG_RT_H, 250.0 * DEG_H, 25000.0 * DEG_H * DEG_RT_H
    rate = np.convolve(result.signal("open_loop_rate.rate")[20_000:], np.full(200, 1 / 200), "valid")[::200]
    seen = []
    for octave in range(9):
        m = 2**octave
        means = np.convolve(rate, np.full(m, 1.0 / m), "valid")
        found = 0.5 * np.mean(np.square(means[m:] - means[:-m]))
        tau = 0.02 * m
        parts = np.array([white**2 / tau, 2 * math.log(2) / math.pi * floor**2, walk**2 * tau / 3])
        seen.append(parts.argmax())
        # a record of so many averaging times has about as many degrees of freedom; flicker is good to 4.5 %
        scatter = math.sqrt(2.0 / (len(rate) / m - 1.0) + 0.09**2)
        assert found / parts.sum() == pytest.approx(1.0, abs=3.0 * scatter), tau
    assert sorted(set(seen)) == [0, 1, 2], "each noise is the largest somewhere"


def force(device: tuple[float, float, float, float], cross: tuple[float, float], omega: float, w: list[float]) -> float:
    """Return rms times root 2 of the force along x for x = sin w1 t, y = 1.2 sin w2 t, uN; tones add as squares."""
    mass, k, d, amplitude = device
    along = abs(k - mass * w[0] ** 2 + 1j * w[0] * d) * amplitude
    across = abs(cross[0] + 1j * w[1] * (cross[1] - 2.0 * mass * omega)) * 1.2
    return math.hypot(along, across)


def test_force_off_and_on_resonance():
    """4 times less on the resonances of set A, and 1800 times without its cross terms and without a rate."""
    axis = (0.18, 63.955, 1.8e-3, 1.0)
    off, on = ([2e-3 * math.pi * hz for hz in pair] for pair in ((663.676, 813.282), (3000.0, 3674.0)))
    found = run(get("gyro-off-resonance")).metrics
    coupled = [force(axis, (12.779, 3.6e-4), 0.1, w) for w in (off, on)]
    measured = [found["sync.drive_force_un"], found["twins.on_resonance.sync.drive_force_un"]]
    assert measured == pytest.approx(coupled, rel=5e-3)
    assert coupled[0] / coupled[1] == pytest.approx(4.08, abs=0.01)

    exact = [math.sqrt(63.955 / 0.18), math.sqrt(95.92 / 0.18)]
    alone = [force(axis, (0.0, 0.0), 0.0, w) for w in (off, exact)]
    assert alone[0] / alone[1] == pytest.approx(1793.0, rel=1e-3)
    document = {
        "device": {"id": "gyro-a", "gyroscope": {"stiffness_xy_n_m": 0.0, "damping_xy_ns_m": 0.0}},
        "plant": {"model": "gyroscope", "thermal_noise": False},
        "sample_rate_khz": 1000,
        "duration_ms": 400,
    }
    needed = []
    for w in (off, exact):
        hz = [1e3 * one / (2 * math.pi) for one in w]
        law = {"kind": "adaptive_rate", "frequency_x_hz": hz[0], "frequency_y_hz": hz[1]}
        needed.append(run(Scenario.load({**document, "controller": law})).metrics["sync.drive_force_un"])
    assert needed == pytest.approx(alone, rel=0.02)
