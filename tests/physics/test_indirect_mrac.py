"""Indirect MRAC: the law from its equations, the gain map, the tracking."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import cont2discrete

from tests.lab import inject, make, phasor, play, rms
from tests.loop import A1, KP, KRAD, W0, follow, simulate, tail

TWO_TONES = {"kind": "multi_sine", "amplitude_v": 5.0, "tones": [{"frequency_hz": KRAD}, {"frequency_hz": 2.9 * KRAD}]}


class Law:
    """3.3.2.5-16 with full matrices and scipy's discretisations; time in 1/w0."""

    def __init__(self, h: float, rate_per_s: float, *, printed: bool) -> None:
        self.h, self.printed = h, printed
        self.mu = np.exp(-1e-3 * rate_per_s * h / W0)
        self.theta, self.p = np.array([KP, A1, 1.0]), 1e3 * np.eye(3)
        square = [1.0, 2.0, 1.0]
        self.u_filter = cont2discrete(([1.0], square), h, "zoh")
        self.y_filters = [cont2discrete((top, square), h, "foh") for top in ([1.0], [1.0, 0.0], [1.0, 0.0, 0.0])]
        self.us, self.ys = np.zeros(3), np.zeros(3)
        self.uf, self.yf = np.zeros(3), np.zeros((3, 3))
        self.w1 = self.w2 = self.last = 0.0

    def __call__(self, r, x, m, u):
        y = x[0]
        # u was held over the interval that ends now: its sample belongs to the start
        self.us = np.array([0.0, u, self.us[1]])
        self.ys = np.array([y, *self.ys[:2]])
        top, bottom, _ = self.u_filter
        uf = top[0] @ self.us - bottom[1:] @ self.uf[:2]
        self.uf = np.array([uf, *self.uf[:2]])
        values = []
        for i, (top, bottom, _) in enumerate(self.y_filters):
            value = top[0] @ self.ys - bottom[1:] @ self.yf[i, :2]
            self.yf[i] = [value, *self.yf[i, :2]]
            values.append(value)
        phi, z = np.array([uf, -values[1], -values[0]]), values[2]
        m2 = 1.0 + 10.0 * phi @ phi
        gain = self.p @ phi / (m2 * self.mu / self.h + phi @ self.p @ phi)
        self.theta = self.theta + gain * (z - self.theta @ phi)
        self.p = (self.p - np.outer(gain, phi @ self.p)) / self.mu
        self.w1, self.w2, self.last = follow(u, self.w1, self.h), follow(self.last, self.w2, self.h), y
        kp, a1, a2 = self.theta
        alpha = a1 - A1
        b1 = (a2 + (1 - alpha) * a1 - A1 - 1) / kp
        b0 = (a2 * (1 - alpha) - 1) / kp
        k = kp / KP if self.printed else KP / kp
        return k * r + alpha * self.w1 + b1 * y + (b0 - b1) * self.w2


@pytest.mark.parametrize("gain_map", ["working", "printed"])
def test_indirect_mrac_is_the_loop_of_the_equations(gain_map):
    board = make({"controller": {"kind": "indirect_mrac", "gain_map": gain_map}})
    inject(board, added_mass=0.05, stiffness=0.8)
    trace = play(board, 600)
    law = Law(0.01 * W0, 30.0, printed=gain_map == "printed")
    expected = simulate(law, 600, 0.01 * W0, mass=1.05, stiffness=1.8)
    np.testing.assert_allclose(trace["plant.displacement"], expected["y"], atol=1e-7)
    np.testing.assert_allclose(trace["drive.voltage"], expected["u"], atol=1e-6)
    found = [trace[f"indirect_mrac.parameter.{name}"][-1] for name in ("gain", "a1", "a2")]
    np.testing.assert_allclose(found, law.theta, atol=1e-6)
    assert trace["indirect_mrac.trace"][-1] == pytest.approx(np.trace(law.p), rel=1e-5)


@pytest.mark.parametrize(("gain_map", "ratio", "within"), [("working", 1.0, 0.004), ("printed", 1.05**-2, 0.006)])
def test_displacement_with_more_mass(gain_map, ratio, within):
    """K = K_p/K_m asks for (K_p/K_m)^2 of the displacement, and K_p goes with 1/m."""
    board = make({"controller": {"kind": "indirect_mrac", "gain_map": gain_map}, "reference": TWO_TONES})
    inject(board, added_mass=0.05)
    trace = play(board, 10_000)
    x, model = (phasor(trace[name][7500:], KRAD, 0.01, 7500) for name in ("plant.displacement", "model.displacement"))
    assert abs(x / model) == pytest.approx(ratio, abs=within)


def test_finds_the_aged_device_and_the_gains_that_match_it():
    board = make({"controller": {"kind": "indirect_mrac"}, "reference": TWO_TONES, "sample_rate_khz": 1000})
    inject(board, added_mass=0.05, stiffness=0.8)
    trace = play(board, 40_000)
    for name, true in (("gain", KP / 1.05), ("a1", A1 / 1.05), ("a2", 1.8 / 1.05)):
        assert trace[f"indirect_mrac.parameter_true.{name}"][-1] == pytest.approx(true, rel=1e-9)
        assert trace[f"indirect_mrac.parameter.{name}"][-1] == pytest.approx(true, rel=0.03)
    assert trace["indirect_mrac.gain.r"][-1] == pytest.approx(1.05, rel=0.03)
    assert trace["indirect_mrac.gain_ideal.y"][-1] == pytest.approx(trace["indirect_mrac.gain.y"][-1], rel=0.05)
    assert rms(tail(trace)) < 0.003


def test_trace_limit_and_gain_floor_hold_without_excitation():
    quiet = {"reference": {"kind": "constant", "amplitude_v": 5.0}, "sensor.noise_um": 0.01}
    params = {"forgetting_rate": 3000.0, "trace_limit": 1e4, "gain_floor": 0.5}
    trace = play(make({**quiet, "controllers": {"indirect_mrac": params}}), 10_000)
    assert trace["indirect_mrac.trace"].max() <= 1e4 * (1 + 1e-9)
    assert np.all(trace["indirect_mrac.parameter.gain"] <= 0.5 * KP)
    free = play(make({**quiet, "controllers": {"indirect_mrac": {**params, "trace_limit": 0.0}}}), 10_000)
    assert free["indirect_mrac.trace"].max() > 1e5


@pytest.mark.parametrize("stiffness", [0.5, 1.0, 1.46])
def test_effort_falls_only_for_a_softer_device(stiffness):
    """|G_nominal/G_fault| at 1 krad/s: what figure 3.3.3.5 shows is half the stiffness, not more mass."""
    board = make({"controller": {"kind": "indirect_mrac"}})
    inject(board, stiffness=stiffness - 1)
    trace = play(board, 10_000)
    u, r = (phasor(trace[f"{name}.voltage"][7500:], KRAD, 0.01) for name in ("drive", "reference"))
    s = 1j / W0
    assert abs(u / r) == pytest.approx(abs((s**2 + A1 * s + stiffness) / (s**2 + A1 * s + 1)), rel=0.01)


def test_what_is_left_of_the_error_goes_with_the_sample():
    def left(rate_khz: int) -> float:
        board = make({"controller": {"kind": "indirect_mrac"}, "reference": TWO_TONES, "sample_rate_khz": rate_khz})
        inject(board, added_mass=0.05, stiffness=0.8)
        return rms(tail(play(board, 100 * rate_khz)))

    found = [left(rate) for rate in (50, 100, 200)]
    assert found[0] / found[1] == pytest.approx(2.0, rel=0.15) and found[1] / found[2] == pytest.approx(2.0, rel=0.15)
    assert found[1] < 0.015


def test_ten_times_the_mass_is_easier_than_for_the_direct_law():
    peaks = {}
    for kind in ("indirect_mrac", "mrac"):
        board = make({"controller": {"kind": kind}})
        inject(board, added_mass=9.0)
        trace = play(board, 5000)
        peaks[kind] = np.abs(trace["plant.displacement"] - trace["model.displacement"]).max()
        if kind == "indirect_mrac":
            assert rms(tail(trace)) < 0.01
    assert peaks["indirect_mrac"] < 4.5 < peaks["mrac"]
